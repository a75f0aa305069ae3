#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes results/boxes.csv, what benchmark-boxes measures of FEMWARP on 35 random boxes.

    python3 Testing/Benchmark/boxes.py [PROGRAM]    # default: build/paraview/bin/benchmark-boxes"""
import csv
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "Utilities"))
from study_pieces import ORIGIN, origin  # noqa: E402  (needs the path above)

TABLE = ROOT / "Testing/Benchmark/results/boxes.csv"
ARGUMENTS = ("FEMWARP", "35", "100000", "1")


def main():
    program = sys.argv[1] if len(sys.argv) > 1 else ROOT / "build/paraview/bin/benchmark-boxes"
    printed = subprocess.run([program, *ARGUMENTS], check=True, capture_output=True,
                             text=True).stdout.splitlines()
    head = next(number for number, line in enumerate(printed) if line.startswith("cells,"))
    with open(TABLE, "w", encoding="utf-8", newline="") as out:
        table = csv.writer(out, lineterminator="\n")
        table.writerow([*printed[head].split(","), *ORIGIN])
        table.writerows([*line.split(","), *origin()] for line in printed[head + 1:])


if __name__ == "__main__":
    main()
