#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The experiment of the paper, with its six methods and two more: four models as
hexahedra and as tetrahedra, in 20 absolute and relative steps, and beyond them until the first
inverted cell; surfaces by weighted residual, as in the paper, and exact.

    Utilities/study.sh                              # builds, and runs this: many hours
    pvpython Utilities/study.py --models bore pipe  # part of it
    pvpython Utilities/study.py --quick             # a small mesh, 4 steps
    pvpython Utilities/study.py --list              # which series are missing, and in which state
    Utilities/study.sh --minutes 60 --fresh         # a piece; again for the next one
    pvpython Utilities/study.py --report            # tables and plots again, from what is there

Writes to --output: results.csv (a row for each step, as it is computed), timing.csv (seconds per
step), scaling.csv, Results.md with the tables, and figure-*.png. Resumes where an
earlier run with the same output was interrupted. Validity is None: the cells that each method
itself inverts are counted."""

import argparse
import os
import sys
from pathlib import Path

from vtkmodules.vtkCommonCore import vtkLogger

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "Data"), str(ROOT / "Utilities")]
import Models  # noqa: E402  (needs the path above)
import study_scaling  # noqa: E402
import study_timing  # noqa: E402
from built_plugin import add_plugin, load_plugin  # noqa: E402
from study_boundary import read_boundaries, times  # noqa: E402
from study_mesh import study_mesh  # noqa: E402
from study_paper import STEPPINGS, STEPS  # noqa: E402
from study_pieces import Deadline, OutOfTime, commit as commit_of_sources  # noqa: E402
from study_records import Records, Series  # noqa: E402
from study_report import write_report  # noqa: E402
from study_series import METHODS, run  # noqa: E402

SURFACES = ("weighted residual", "exact")


def matrix(arguments):
    """The chosen part of the matrix: {(model, kind): its Series}."""
    return {(name, kind): [Series(name, kind, surfaces, stepping, method)
                           for surfaces in arguments.surfaces
                           for stepping in arguments.steppings for method in arguments.methods]
            for name in arguments.models for kind in arguments.kinds}


def study(arguments, records, commit, deadline):
    """Runs the chosen part of the matrix, a mesh at a time."""
    for (name, kind), all_series in matrix(arguments).items():
        ts = times(Models.get(name), arguments.steps)
        last = arguments.steps + 1 if arguments.to_final else len(ts)
        mesh = study_mesh(name, kind, arguments.small)
        for series in all_series:
            boundaries = read_boundaries(arguments.output, series, mesh, ts)
            run(series, mesh, boundaries, ts[:min(last, len(boundaries.positions))],
                arguments.steps, records, arguments.threads, commit, arguments.fresh, deadline)
            print(f"done: {series}", flush=True)


def list_missing(arguments, records, commit):
    """Prints a line for each series that does not reach S_F yet."""
    for all_series in matrix(arguments).values():
        for series in all_series:
            steps = records.steps(series, commit if arguments.fresh else None)
            if len(steps) <= arguments.steps:
                print(f"{series}: {len(steps)} of {arguments.steps + 1} steps to S_F")


def time_steps(arguments, deadline):
    """Seconds per step."""
    study_timing.run(arguments.output / "timing.csv", arguments.models, arguments.kinds,
                     arguments.methods, arguments.steps, arguments.small, arguments.repeats,
                     arguments.threads, deadline)


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--output", type=Path, default=Path("study-output"), metavar="DIR",
                        help="default: %(default)s")
    parser.add_argument("--models", nargs="+", choices=Models.NAMES + Models.VARIANTS,
                        default=list(Models.NAMES), metavar="MODEL",
                        help="default: the paper's four")
    parser.add_argument("--kinds", nargs="+", choices=("hex", "tet"), default=["hex", "tet"])
    parser.add_argument("--surfaces", nargs="+", choices=SURFACES, default=list(SURFACES))
    parser.add_argument("--steppings", nargs="+", choices=STEPPINGS, default=list(STEPPINGS))
    parser.add_argument("--methods", nargs="+", choices=list(METHODS), default=list(METHODS),
                        metavar="METHOD", help="default: all eight")
    parser.add_argument("--steps", type=int, default=STEPS,
                        help="from S_0 to S_F (default: %(default)s)")
    parser.add_argument("--to-final", action="store_true",
                        help="end each series at S_F; without it, t* is looked for")
    parser.add_argument("--threads", type=int, default=os.cpu_count(), metavar="N",
                        help="for each filter (default: one for each core, %(default)s)")
    parser.add_argument("--small", action="store_true",
                        help="the small meshes, in Data/Models/small")
    parser.add_argument("--no-matrix", action="store_true", help="leave the series of steps out")
    parser.add_argument("--no-timing", action="store_true", help="leave the seconds per step out")
    parser.add_argument("--no-scaling", action="store_true", help="leave the bricks out")
    parser.add_argument("--fresh", action="store_true",
                        help="rows of other commits of the sources count as missing")
    parser.add_argument("--minutes", type=float, metavar="N",
                        help="end after so many minutes, at the next step; what is there is kept")
    parser.add_argument("--list", action="store_true",
                        help="name the series that do not reach S_F yet, and run nothing")
    parser.add_argument("--quick", action="store_true",
                        help="a small bore, 4 steps, one brick: in a minute")
    parser.add_argument("--report", action="store_true", help="run nothing")
    add_plugin(parser)
    arguments = parser.parse_args()
    arguments.sizes, arguments.repeats = study_scaling.SIZES, study_scaling.REPEATS
    if arguments.quick:
        arguments.models, arguments.steps, arguments.small = ["bore"], 4, True
        arguments.sizes, arguments.repeats = (2,), 1
    return arguments


def run_all(arguments, records, commit, deadline):
    """All that is asked for and missing. Raises OutOfTime."""
    if not arguments.no_matrix:
        study(arguments, records, commit, deadline)
    if not arguments.no_timing:
        time_steps(arguments, deadline)
    if not arguments.no_scaling:
        study_scaling.run(arguments.output / "scaling.csv", arguments.methods, arguments.sizes,
                          arguments.repeats, arguments.threads, deadline)


def main():
    arguments = parse_arguments()
    arguments.output.mkdir(parents=True, exist_ok=True)
    records = Records(arguments.output / "results.csv")
    commit = commit_of_sources()
    if arguments.list:
        list_missing(arguments, records, commit)
        return
    if not arguments.report:
        load_plugin(arguments.plugin)
        # Folded faces and inverted cells, of which filters warn at each step, are in the tables.
        vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_ERROR)
        try:
            run_all(arguments, records, commit, Deadline(arguments.minutes))
        except OutOfTime:
            print("The minutes are over: run it again for the rest.")
    write_report(arguments.output, records, arguments.steps)


if __name__ == "__main__":
    main()
