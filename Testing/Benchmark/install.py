#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What the packages of install-packages.sh --use take on this Debian, without those that its
smallest system has, as the index of apt has them.

    Testing/Benchmark/install.py    # after apt-get update

Writes this release's row of results/install.csv: megabytes to download, and on the disk."""

import csv
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
DATA = ROOT / "Testing/Benchmark/results/install.csv"
sys.path.insert(0, str(ROOT / "Utilities"))
from study_pieces import commit  # noqa: E402  (needs the path above)

FIELDS = ("release", "download_MB", "disk_MB", "commit")


def apt(program, folder, *arguments):
    """The output of a program of apt that takes no package for installed."""
    options = ("Dir::State::status=/dev/null", f"Dir::Cache={folder}", "Debug::NoLocking=1")
    command = [program, *(f"-o{option}" for option in options), *arguments]
    return subprocess.run(command, capture_output=True, text=True,
                          env={**os.environ, "LC_ALL": "C"}).stdout


def megabytes(folder, packages):
    """(to download, on the disk) of packages and all that they need."""
    said = apt("apt-get", folder, "--no-install-recommends", "--assume-no", "install", *packages)
    found = re.search(r"Need to get ([\d.,]+) MB of archives.*?operation, ([\d.,]+) MB", said,
                      re.DOTALL)
    if not found:
        sys.exit(f"install.py: apt does not say what it needs. Run apt-get update first.\n{said}")
    return tuple(float(number.replace(",", "")) for number in found.groups())


def packages_row():
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "archives/partial").mkdir(parents=True)
        known = apt("apt-cache", folder, "dumpavail").split("\n\n")
        smallest = ["apt"] + [re.search(r"^Package: (.*)", one, re.M)[1] for one in known
                              if re.search(r"^Priority: required$", one, re.M)]
        ours = subprocess.run([ROOT / "Utilities/install-packages.sh", "--use", "--list"],
                              check=True, capture_output=True, text=True).stdout.split()
        less, all_ = megabytes(folder, smallest), megabytes(folder, smallest + ours)
    return {"download_MB": round(all_[0] - less[0]), "disk_MB": round(all_[1] - less[1])}


def main():
    text = Path("/etc/os-release").read_text(encoding="utf-8")
    system = dict(re.findall(r'^(\w+)="?(.*?)"?$', text, re.MULTILINE))
    release = system["ID"] + " " + system.get("VERSION_ID", "unstable")
    row = {"release": release, "commit": commit(), **packages_row()}
    with open(DATA, encoding="utf-8") as file:
        others = [other for other in csv.DictReader(file) if other["release"] != release]
    with open(DATA, "w", encoding="utf-8", newline="") as file:
        table = csv.DictWriter(file, FIELDS, lineterminator="\n")
        table.writeheader()
        table.writerows(sorted([*others, row], key=lambda one: one["release"]))


if __name__ == "__main__":
    main()
