#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Inversion-free beside MFEM's optimization of meshes, on a mesh whose boundary stays.

    optimizers.py write FOLDER FILE.vtk...   # the starts, FOLDER/NAME.vtk
    optimizers.py table FOLDER FILE.vtk...   # results/optimizers.csv, with FOLDER/NAME-mfem.vtk

Files have the point array `fixed`. A cube twisted by 360 degrees and the bore's hexahedra at S_F
follow, which start from FEMWARP's mesh. Between the two calls run mfem_optimizer.cxx on each start,
on a Debian 13 with libmfem-dev; it prints its seconds, which go into FOLDER/NAME-mfem.txt. Needs
the Python module of build/paraview."""

import csv
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
sys.path[:0] = [str(ROOT / "Utilities"),
                *map(str, ROOT.glob("build/paraview/lib/python3*/site-packages"))]
import benchmark_inversion_free as problems  # noqa: E402  (needs the path above)
from study_pieces import ORIGIN, origin  # noqa: E402
import meshmorphing as mm  # noqa: E402
import numpy as np  # noqa: E402

TABLE = ROOT / "Testing" / "Benchmark" / "results" / "optimizers.csv"
#: Of a mesh. Where nothing is asked to move, Inversion Free leaves a valid mesh alone.
TINY = 1e-9


def write(file, points, problem):
    with open(file, "w", encoding="ascii") as out:
        out.write("# vtk DataFile Version 3.0\nstart\nASCII\nDATASET UNSTRUCTURED_GRID\n"
                  f"POINTS {len(points)} double\n")
        np.savetxt(out, points, "%.17g")
        cells = np.split(problem.connectivity, problem.offsets[1:-1])
        out.write(f"CELLS {len(cells)} {len(cells) + len(problem.connectivity)}\n")
        out.writelines(f"{len(cell)} {' '.join(map(str, cell))}\n" for cell in cells)
        out.write(f"CELL_TYPES {len(cells)}\n")
        np.savetxt(out, problem.types, "%d")


def prepared(problem):
    """(mesh, motion of its boundary, points to start from)"""
    mesh = mm.Mesh(problem.points, (problem.offsets, problem.connectivity, problem.types))
    motion = problem.target - problem.points[problem.prescribed]
    start = problem.points
    if motion.any():
        start = mm.FEMWARP().prepare(mesh, problem.prescribed).evaluate(motion)
    return mesh, motion, start


def rows(name, problem, folder):
    mesh, motion, start = prepared(problem)

    def row(program, points, seconds):
        quality = mm.quality(mesh, points)
        return [name, program, f"{quality.minimum:.4f}", f"{quality.mean:.4f}", quality.inverted,
                seconds, *origin()]

    yield row("start", start, "")
    moved = motion + TINY * np.ptp(problem.points)
    for effort in ("Default", "Thorough"):
        method = mm.InversionFree(effort=effort).prepare(mesh, problem.prescribed)
        before = time.process_time()
        points = method.evaluate(moved)
        yield row(effort, points, f"{time.process_time() - before:.2f}")
    result = folder / f"{name}-mfem.vtk"
    if result.exists():
        seconds = result.with_suffix(".txt").read_text(encoding="ascii").split("=")[-1].strip()
        yield row("MFEM", problems.grid_of(result)[1], seconds)


def main():
    task, folder, *files = sys.argv[1:]
    mm.set_threads(1)
    cases = {Path(file).stem.split(".")[0]: problems.mesh_of(file) for file in files}
    cases |= {"twist": problems.twist(20, 360), "bore_hex": problems.model("bore_hex")}
    if task == "write":
        for name, problem in cases.items():
            write(Path(folder) / f"{name}.vtk", prepared(problem)[2], problem)
        return
    with open(TABLE, "w", encoding="ascii", newline="") as out:
        table = csv.writer(out, lineterminator="\n")
        table.writerow(["mesh", "program", "minimum", "mean", "inverted", "processor_seconds",
                        *ORIGIN])
        for name, problem in cases.items():
            table.writerows(rows(name, problem, Path(folder)))


if __name__ == "__main__":
    main()
