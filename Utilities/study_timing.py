# SPDX-License-Identifier: BSD-3-Clause
"""What a step costs: the paper's Tables 2 to 5, as medians of several runs; and its direct solver
KLU on the systems of FEMWARP and LBWARP.

Of the absolute step to S_F the evaluation alone counts, since all steps share one preparation. A
relative step is the first of 20, with its preparation. Surfaces are exact, which costs the methods
nothing."""

import csv
import re
import subprocess
from pathlib import Path
from statistics import median

from paraview import simple

import Models
from demo_picture import producer
from Models.vtk_files import write_grid
from study_mesh import study_mesh
from study_paper import PANELS, STEPPINGS
from study_records import RowFile
from study_scaling import seconds

#: A method slower than that is run once.
SLOW = 60
FIELDS = ("model", "kind", "stepping", "method", "prepare", "evaluate", "runs", "threads")


def run(path, models, kinds, methods, steps, small, repeats, threads, deadline):
    """Writes a row for each model, kind, stepping and method to the CSV file `path`, and resumes
    where an earlier call has stopped. Raises OutOfTime between rows."""
    file = RowFile(path, FIELDS)
    done = {tuple(row.values())[:4] for row in file.rows()}
    for name in models:
        for kind in kinds:
            if all((name, kind, stepping, method) in done
                   for stepping in STEPPINGS for method in methods):
                continue
            mesh = study_mesh(name, kind, small)
            rest = producer(mesh.to_vtk())
            for stepping, t in zip(STEPPINGS, (1 / steps, 1)):
                boundary = producer(mesh.boundary_to_vtk(t))
                for method in methods:
                    if (name, kind, stepping, method) not in done:
                        deadline.check()
                        file.add((name, kind, stepping, method,
                                  *_medians(method, rest, boundary, repeats, threads), threads))
                simple.Delete(boundary)
            simple.Delete(rest)


def _medians(method, rest, boundary, repeats, threads):
    """prepare, evaluate, runs."""
    found = [seconds(method, rest, boundary, threads)]
    while len(found) < repeats and sum(found[0]) < SLOW:
        found.append(seconds(method, rest, boundary, threads))
    prepare, evaluate = (median(values) for values in zip(*found))
    return prepare, evaluate, len(found)


def run_klu(folder, program, models, kinds, small, limit, deadline):
    """Writes klu-MODEL-KIND.csv to the folder, by benchmark-mesh, which gives KLU `limit` seconds a
    system. Raises OutOfTime between meshes."""
    for name in models:
        for kind in kinds:
            file = folder / f"klu-{name}-{kind}.csv"
            if file.is_file():
                continue
            deadline.check()
            mesh = study_mesh(name, kind, small)
            grid = folder / f"{name}_{kind}.vtu"
            write_grid(mesh.to_vtk(), grid)
            partial = file.with_name("partial-" + file.name)
            # 3: something could not be measured, a solver that did not end for one.
            code = subprocess.run([program, "--klu-limit", str(limit), "--csv", partial, grid],
                                  check=False).returncode
            grid.unlink()
            if code not in (0, 3):
                raise RuntimeError(f"{program} ended with {code} on {name}, {kind}")
            partial.replace(file)


def read(path):
    """{(model, kind, stepping, method): (prepare, evaluate, runs, threads)}, as texts but for the
    seconds."""
    return {tuple(row.values())[:4]: (float(row["prepare"]), float(row["evaluate"]), row["runs"],
                                      row["threads"]) for row in RowFile(path, FIELDS).rows()}


def read_klu(folder):
    """{(model, kind, method): {figure: value}} of FEMWARP and LBWARP: `warm`, `KLU cold` and so on,
    without the threads."""
    found = {}
    for name in Models.NAMES:
        for kind, _ in PANELS[::2]:
            file = Path(folder) / f"klu-{name}-{kind}.csv"
            if not file.is_file():
                continue
            with open(file, newline="", encoding="utf-8") as text:
                for row in csv.DictReader(text):
                    mesh_and_method, figure = row["figure"].split(": ", 1)
                    method = mesh_and_method.rsplit(", ", 1)[1]
                    found.setdefault((name, kind, method), {})[
                        re.sub(r", \d+ threads?$", "", figure)] = float(row["measured"])
    return found
