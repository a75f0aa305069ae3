#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs Examples/core/MoveSurface.cxx, which knows no VTK, on a block of hexahedra. The arguments
are the command that runs it."""

import subprocess
import sys
import tempfile
from pathlib import Path

N = 4  # cells along each side
command = sys.argv[1:]
temporary = tempfile.TemporaryDirectory(dir=".")  # a path that programs of other systems know
folder = Path(temporary.name)
part, moved = folder / "part.inp", folder / "moved.inp"


def run(*words):
    return subprocess.run([*command, *map(str, words)], capture_output=True, text=True, timeout=300)


def number(i, j, k):
    return 1 + i + (N + 1) * (j + (N + 1) * k)


def coordinates(text):
    rows = text.split("*NODE")[1].split("*ELEMENT")[0].splitlines()[1:]
    return {int(row.split(",")[0]): [float(x) for x in row.split(",")[1:]] for row in rows}


around = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
span, cells = range(N + 1), range(N)
nodes = [f"{number(i, j, k)}, {i}, {j}, {k}" for k in span for j in span for i in span]
elements = [[number(i + a, j + b, k + c) for a, b, c in around]
            for k in cells for j in cells for i in cells]
top = [number(i, j, N) for j in span for i in span]
part.write_text("*HEADING\na block\n*NODE\n" + "\n".join(nodes) + "\n*ELEMENT, TYPE=C3D8\n"
                + "\n".join(f"{e + 1}, " + ", ".join(map(str, ids))
                            for e, ids in enumerate(elements))
                + "\n*NSET, NSET=TOP\n" + ",\n".join(map(str, top)) + "\n*STEP\n*END STEP\n")

# It lists what the file names, and what it finds.
listed = run(part)
assert listed.returncode == 0, listed.stderr
assert f"TOP: {N * N}, {N * N}\n" in listed.stdout, listed.stdout
assert "Surface 0: " in listed.stdout, listed.stdout

# The top moves, and nothing but coordinates changes in the file.
done = run(part, "TOP", 0.5, 0, 1, moved)
assert done.returncode == 0, done.stderr
assert "before: minimum scaled Jacobian 1, inverted 0" in done.stdout, done.stdout
assert "Valid" in done.stdout, done.stdout
before, after = part.read_text(), moved.read_text()
assert before.split("*ELEMENT")[1] == after.split("*ELEMENT")[1]
old, new = coordinates(before), coordinates(after)
for node in top:
    shift = [b - a for a, b in zip(old[node], new[node])]
    assert max(abs(s - t) for s, t in zip(shift, [0.5, 0, 1])) < 1e-6, (node, shift)
assert all(new[number(i, j, 0)] == old[number(i, j, 0)] for i in span for j in span)
assert 0 < new[number(2, 2, 2)][2] - 2 < 1, new[number(2, 2, 2)]

# A surface that is not there, and a file that is not there.
unknown = run(part, "BORE", 0.5, 0, 1, moved)
assert unknown.returncode == 1 and "BORE" in unknown.stderr and "TOP" in unknown.stderr
assert run(folder / "none.inp").returncode == 1
print("move-surface: listed, moved, and told what is wrong")
