# SPDX-License-Identifier: BSD-3-Clause
"""What a step costs: the paper's Tables 2 to 5, as medians of several runs.

Of the absolute step to S_F the evaluation alone counts, since all steps share one preparation. A
relative step is the first of 20, with its preparation. Surfaces are exact, which costs the methods
nothing."""

from statistics import median

from paraview import simple

from demo_picture import producer
from study_mesh import study_mesh
from study_paper import STEPPINGS
from study_pieces import ORIGIN, origin
from study_records import RowFile
from study_scaling import seconds

#: A method slower than that is run once.
SLOW = 60
FIELDS = ("model", "kind", "stepping", "method", "prepare", "evaluate", "runs", "threads",
          *ORIGIN)


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
                                  *_medians(method, rest, boundary, repeats, threads), threads,
                                  *origin()))
                simple.Delete(boundary)
            simple.Delete(rest)


def _medians(method, rest, boundary, repeats, threads):
    """prepare, evaluate, runs."""
    found = [seconds(method, rest, boundary, threads)]
    while len(found) < repeats and sum(found[0]) < SLOW:
        found.append(seconds(method, rest, boundary, threads))
    prepare, evaluate = (median(values) for values in zip(*found))
    return prepare, evaluate, len(found)


def read(path):
    """{(model, kind, stepping, method): (prepare, evaluate, runs, threads)}, as texts but for the
    seconds."""
    return {tuple(row.values())[:4]: (float(row["prepare"]), float(row["evaluate"]), row["runs"],
                                      row["threads"]) for row in RowFile(path, FIELDS).rows()}
