#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The inversion-free morph of this tree beside that of an older commit, in one run.

    Utilities/benchmark_inversion_free.py                # an hour on an idle machine; needs Gmsh
    Utilities/benchmark_inversion_free.py --models canister_hex --twists 50 --against ""

Runs the two programs in turn on the eight models at S_F, and on cubes of hexahedra twisted by 360
degrees. Prints seconds, processor seconds and their ratios beside the
goals; the minima, Newton steps and linear iterations; and the memory a cell. Needs this tree's
target inversion-free-probe. The older commit is built under build/against, without ParaView."""

import argparse
import math
import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "Data"))
import numpy as np  # noqa: E402
import Models  # noqa: E402

PROBE = ROOT / "Testing" / "Benchmark" / "InversionFreeProbe.cxx"
HEXAHEDRON, TETRAHEDRON = 12, 10
KINDS = [f"{model}_{kind}" for model in Models.NAMES for kind in ("hex", "tet")]
#: Time at S_F over that of the older commit, at most.
MODEL_GOAL, CANISTER_GOAL = 1 / 3, 1 / 5
#: Time of a twist over the older commit's FEMWARP, prepare included, at most.
TWIST_GOAL = 10


def write_problem(file, points, cells, cell_type, prescribed, target):
    """Writes what Testing/Benchmark/InversionFreeProbe.cxx reads: see readProblem() there."""
    count, corners = cells.shape
    with open(file, "wb") as out:
        for array in (np.array([len(points), count, cells.size, len(prescribed)], np.int64),
                      points.astype(float), target.astype(float),
                      np.arange(count + 1, dtype=np.int64) * corners, cells.astype(np.int64),
                      prescribed.astype(np.int64), np.full(count, cell_type, np.uint8)):
            np.ascontiguousarray(array).tofile(out)


def write_model(file, name, small):
    model, kind = name.split("_")
    mesh = Models.get(model).read_small(kind) if small else Models.get(model).make(kind)
    write_problem(file, mesh.points, mesh.cells, HEXAHEDRON if kind == "hex" else TETRAHEDRON,
                  mesh.nodes, mesh.boundary_positions(1))


def write_twist(file, side):
    """A cube of side^3 unit hexahedra, twisted by 360 degrees about z."""
    axis = np.arange(side + 1)
    z, y, x = (a.ravel() for a in np.meshgrid(axis, axis, axis, indexing="ij"))
    points = np.column_stack([x, y, z]).astype(float)
    first = (np.arange(side)[None, None, :] + (side + 1) * np.arange(side)[None, :, None]
             + (side + 1) ** 2 * np.arange(side)[:, None, None]).ravel()
    base = np.array([0, 1, side + 2, side + 1])
    cells = first[:, None] + np.concatenate([base, base + (side + 1) ** 2])[None, :]
    prescribed = np.flatnonzero(((points == 0) | (points == side)).any(axis=1))
    boundary = points[prescribed]
    angle = 2 * math.pi * boundary[:, 2] / side
    across = boundary[:, :2] - side / 2
    cosine, sine = np.cos(angle), np.sin(angle)
    target = np.column_stack([side / 2 + cosine * across[:, 0] - sine * across[:, 1],
                              side / 2 + sine * across[:, 0] + cosine * across[:, 1],
                              boundary[:, 2]])
    write_problem(file, points, cells, HEXAHEDRON, prescribed, target)


def build_older(commit):
    """Builds the core of `commit` and the probe with it. Returns the probe's path."""
    folder = ROOT / "build" / "against" / commit
    probe = folder / "inversion-free-probe"
    if not (folder / "source").exists():
        subprocess.run(["git", "-C", ROOT, "worktree", "add", "--detach", folder / "source",
                        commit], check=True, stdout=sys.stderr)
    subprocess.run(["cmake", "-S", folder / "source", "-B", folder / "build", "-G", "Ninja",
                    "-DCMAKE_BUILD_TYPE=Release", "-DMESHMORPHING_BUILD_PARAVIEW_PLUGIN=OFF",
                    "-DMESHMORPHING_BUILD_TESTING=OFF", "-DMESHMORPHING_WRAP_PYTHON=OFF",
                    f"-DVTK_DIR={os.environ.get('VTK_DIR', '')}"],
                   check=True, stdout=sys.stderr)
    subprocess.run(["cmake", "--build", folder / "build", "--target", "morph_core"], check=True,
                   stdout=sys.stderr)
    library, = (folder / "build").rglob("libmorph_core.a")
    subprocess.run(["c++", "-std=c++17", "-O2", "-isystem", "/usr/include/eigen3",
                    f"-I{folder / 'source' / 'Filters' / 'Core'}", PROBE, library, "-lmpfr",
                    "-lgmp", "-lpthread", "-o", probe], check=True)
    return probe


def measure(probe, problem, method, threads, limit):
    """The numbers that the probe prints, by name; None where it takes longer than `limit`."""
    try:
        done = subprocess.run([probe, problem, method, str(threads)], check=True, text=True,
                              capture_output=True, timeout=limit)
    except subprocess.TimeoutExpired:
        return None
    return {name: float(value)
            for name, value in (pair.split("=") for pair in done.stdout.split())}


class Comparison:
    def __init__(self, options):
        self.options = options
        self.probes = {"new": options.probe}
        if options.against:
            self.probes["old"] = options.older_probe or build_older(options.against)

    def run(self, problem, method):
        """The probes in turn, so that a slow spell of the machine falls on both: the numbers of
        each with the median seconds."""
        found = {name: [] for name in self.probes}
        for _ in range(self.options.repeat):
            for name, probe in self.probes.items():
                numbers = measure(probe, problem, method, self.options.threads, self.options.limit)
                if numbers is None:
                    print(f"    {name}: no result within {self.options.limit} s", flush=True)
                else:
                    found[name].append(numbers)
        result = {}
        for name, runs in found.items():
            if runs:
                result[name] = dict(runs[0])
                for key in ("prepare", "evaluate", "prepareCpu", "evaluateCpu"):
                    result[name][key] = statistics.median(run[key] for run in runs)
        return result

    def show(self, title, result):
        print(f"{title}", flush=True)
        for name, run in result.items():
            memory = (run["memoryMost"] - run["memoryBefore"]) * 2 ** 10 / run["cells"]
            print(f"    {name}: evaluate {run['evaluate']:.3f} s,"
                  f" processor {run['evaluateCpu']:.3f} s; minimum {run['minimum']:.4f},"
                  f" mean {run['mean']:.4f}, {run['inverted']:.0f} inverted;"
                  f" {run.get('NewtonSteps', 0):.0f} Newton steps,"
                  f" {run.get('LinearIterations', 0):.0f} linear iterations;"
                  f" {memory:.1f} kB a cell", flush=True)

    def goal(self, what, value, most):
        met = "" if self.options.quick else ", met" if value <= most else ", MISSED"
        print(f"    {what}: {value:.3f} (at most {most:.3f}{met})", flush=True)

    def model(self, name, problem):
        result = self.run(problem, "inversion-free")
        self.show(name + " at S_F", result)
        if len(result) == 2:
            goal = CANISTER_GOAL if name == "canister_hex" else MODEL_GOAL
            for key in ("evaluate", "evaluateCpu"):
                self.goal(f"{key} / that of {self.options.against}",
                          result["new"][key] / result["old"][key], goal)
            self.goal("1 - minimum / the older one",
                      1 - result["new"]["minimum"] / result["old"]["minimum"], 0.01)
        return result

    def twist(self, side, problem):
        linear = self.run(problem, "femwarp")
        result = self.run(problem, "inversion-free")
        self.show(f"cube of {side}^3 twisted by 360 degrees", result)
        base = linear.get("old") or linear["new"]
        for kind in ("", "Cpu"):
            cold = base["prepare" + kind] + base["evaluate" + kind]
            if "new" in result:
                self.goal(f"evaluate{kind} / FEMWARP cold"
                          + (f" of {self.options.against}" if "old" in linear else ""),
                          result["new"]["evaluate" + kind] / cold, TWIST_GOAL)
        return result


def parse_arguments():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--models", nargs="*", default=None, metavar="NAME",
                        help=f"default: all of {', '.join(KINDS)}")
    parser.add_argument("--twists", nargs="*", type=int, default=None, metavar="SIDE",
                        help="default: 50 100")
    parser.add_argument("--against", default="eab12e2",
                        help="the older commit; empty for none (default: %(default)s)")
    parser.add_argument("--older-probe", type=Path, help="the older commit's probe, already built")
    parser.add_argument("--probe", type=Path,
                        default=ROOT / "build" / "paraview" / "bin" / "inversion-free-probe")
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--limit", type=float, default=1800, help="seconds for a run")
    parser.add_argument("--quick", action="store_true",
                        help="small meshes, once, without an older commit: that it runs")
    options = parser.parse_args()
    if options.quick:
        options.against, options.repeat = "", 1
    if options.models is None:
        options.models = KINDS[:2] if options.quick else KINDS
    if options.twists is None:
        options.twists = [8] if options.quick else [50, 100]
    unknown = [name for name in options.models if name not in KINDS]
    if unknown:
        parser.error(f"no model {', '.join(unknown)}: choose from {', '.join(KINDS)}")
    return options


def main():
    options = parse_arguments()
    comparison = Comparison(options)
    inverted = 0
    with tempfile.TemporaryDirectory() as folder:
        problem = Path(folder) / "problem.bin"
        for name in options.models:
            write_model(problem, name, options.quick)
            inverted += comparison.model(name, problem)["new"]["inverted"]
        for side in options.twists:
            write_twist(problem, side)
            inverted += comparison.twist(side, problem)["new"]["inverted"]
    if inverted > 0:
        sys.exit(f"{inverted:.0f} cells are inverted")


if __name__ == "__main__":
    main()
