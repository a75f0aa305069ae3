#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The inversion-free morph of this tree, on an idle machine, beside that of an older commit.

    Utilities/benchmark_inversion_free.py                # its three efforts; needs Gmsh
    Utilities/benchmark_inversion_free.py --against COMMIT --models bore_hex --twists 30:360

Morphs cubes of hexahedra whose boundary is twisted (SIDE:DEGREES) and stretched, the models at S_F,
and files of other people's meshes, whose point array `fixed` names the nodes that stay. The
programs run in turn. Prints a row for each: median seconds and processor seconds of the morph,
their ratio to the older commit's, minimum and mean scaled Jacobian, inverted cells and Newton
steps. Needs this tree's target inversion-free-probe. The older commit's core is built under
build/against."""

import argparse
import math
import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "Data"))
import numpy as np  # noqa: E402
import Models  # noqa: E402
from vtkmodules.util.numpy_support import vtk_to_numpy  # noqa: E402
from vtkmodules.vtkIOLegacy import vtkUnstructuredGridReader  # noqa: E402

PROBE = ROOT / "Testing" / "Benchmark" / "InversionFreeProbe.cxx"
HEXAHEDRON, TETRAHEDRON = 12, 10
MODELS = [f"{model}_{kind}" for model in Models.NAMES for kind in ("hex", "tet")]
TWISTS = ["30:360", "30:540", "30:720", "50:360"]
#: Steps that may raise the minimum, by the value of *Effort*.
EFFORTS = {"quick": 14, "default": 40, "thorough": 200}


class Problem(NamedTuple):
    """Cells in VTK's manner, and where the prescribed nodes go: (#prescribed, 3)."""

    points: np.ndarray
    offsets: np.ndarray
    connectivity: np.ndarray
    types: np.ndarray
    prescribed: np.ndarray
    target: np.ndarray

    def write(self, file):
        """What Testing/Benchmark/InversionFreeProbe.cxx reads: see readProblem() there."""
        with open(file, "wb") as out:
            sizes = [len(self.points), len(self.types), len(self.connectivity),
                     len(self.prescribed)]
            for array, kind in ((sizes, np.int64), (self.points, float), (self.target, float),
                                (self.offsets, np.int64), (self.connectivity, np.int64),
                                (self.prescribed, np.int64), (self.types, np.uint8)):
                np.ascontiguousarray(array, kind).tofile(out)


def of_one_type(points, cells, cell_type, prescribed, target):
    """`cells`: #cells x #corners."""
    count, corners = cells.shape
    return Problem(points, np.arange(count + 1) * corners, cells.ravel(),
                   np.full(count, cell_type), prescribed, target)


def model(name, small=False):
    geometry, kind = name.split("_")
    found = Models.get(geometry)
    mesh = found.read_small(kind) if small else found.make(kind)
    return of_one_type(mesh.points, mesh.cells, HEXAHEDRON if kind == "hex" else TETRAHEDRON,
                       mesh.nodes, mesh.boundary_positions(1))


def twist(side, degrees):
    """A cube of side^3 unit hexahedra, twisted about z and stretched 1.5 times along it."""
    axis = np.arange(side + 1)
    z, y, x = (a.ravel() for a in np.meshgrid(axis, axis, axis, indexing="ij"))
    points = np.column_stack([x, y, z]).astype(float)
    first = (np.arange(side)[None, None, :] + (side + 1) * np.arange(side)[None, :, None]
             + (side + 1) ** 2 * np.arange(side)[:, None, None]).ravel()
    base = np.array([0, 1, side + 2, side + 1])
    cells = first[:, None] + np.concatenate([base, base + (side + 1) ** 2])[None, :]
    prescribed = np.flatnonzero(((points == 0) | (points == side)).any(axis=1))
    boundary = points[prescribed]
    angle = math.radians(degrees) * boundary[:, 2] / side
    across = boundary[:, :2] - side / 2
    cosine, sine = np.cos(angle), np.sin(angle)
    target = np.column_stack([side / 2 + cosine * across[:, 0] - sine * across[:, 1],
                              side / 2 + sine * across[:, 0] + cosine * across[:, 1],
                              1.5 * boundary[:, 2]])
    return of_one_type(points, cells, HEXAHEDRON, prescribed, target)


def grid_of(file):
    """(vtkUnstructuredGrid, its points) of a legacy VTK file."""
    reader = vtkUnstructuredGridReader()
    reader.SetFileName(str(file))
    reader.Update()
    grid = reader.GetOutput()
    return grid, vtk_to_numpy(grid.GetPoints().GetData()).astype(float)


def mesh_of(file):
    """A file's mesh, whose nodes with fixed == 1 stay where they are."""
    grid, points = grid_of(file)
    fixed = np.flatnonzero(vtk_to_numpy(grid.GetPointData().GetArray("fixed")) == 1)
    return Problem(points, vtk_to_numpy(grid.GetCells().GetOffsetsArray()),
                   vtk_to_numpy(grid.GetCells().GetConnectivityArray()),
                   vtk_to_numpy(grid.GetCellTypesArray()), fixed, points[fixed])


def build_older(commit):
    """Builds the core of `commit`, and the probe with it. Returns the probe's path."""
    folder = ROOT / "build" / "against" / commit
    probe = folder / "inversion-free-probe"
    if not (folder / "source").exists():
        subprocess.run(["git", "-C", ROOT, "worktree", "add", "--detach", folder / "source",
                        commit], check=True, stdout=sys.stderr)
    subprocess.run(["cmake", "-S", folder / "source", "-B", folder / "build", "-G", "Ninja",
                    "-DCMAKE_BUILD_TYPE=Release", "-DMESHMORPHING_BUILD_PARAVIEW_PLUGIN=OFF",
                    "-DMESHMORPHING_BUILD_TESTING=OFF", "-DMESHMORPHING_WRAP_PYTHON=OFF",
                    "-DMESHMORPHING_USE_MPI=OFF", f"-DVTK_DIR={os.environ.get('VTK_DIR', '')}"],
                   check=True, stdout=sys.stderr)
    subprocess.run(["cmake", "--build", folder / "build", "--target", "morph_core"], check=True,
                   stdout=sys.stderr)
    library, = (folder / "build").rglob("libmorph_core.a")
    # Older cores have parallelFor() in the place of share().
    subprocess.run(["c++", "-std=c++17", "-O2", "-Dshare=parallelFor", "-isystem",
                    "/usr/include/eigen3",
                    f"-I{folder / 'source' / 'Filters' / 'Core'}", PROBE, library, "-lmpfr",
                    "-lgmp", "-lpthread", "-o", probe], check=True)
    return probe


def measure(command, limit):
    """The numbers that the probe prints, by name; None if it takes longer than `limit`."""
    try:
        done = subprocess.run(command, check=True, text=True, stdout=subprocess.PIPE, timeout=limit)
    except subprocess.TimeoutExpired:
        return None
    return {name: float(value)
            for name, value in (pair.split("=") for pair in done.stdout.split())}


def compare(title, problem, programs, options):
    """Runs the programs in turn, so that a slow spell of the machine falls on all, and prints
    their rows. Returns the most inverted cells of any of this tree."""
    runs = {name: [] for name in programs}
    for _ in range(options.repeat):
        for name, (probe, *steps) in programs.items():
            found = measure([probe, problem, str(options.threads), *steps], options.limit)
            if found:
                runs[name].append(found)
    median = {name: {key: statistics.median(run[key] for run in found) for key in found[0]}
              for name, found in runs.items() if found}
    older = median.get(options.against)
    for name in programs:
        if name not in median:
            print(f"{title:24} {name:9} no result within {options.limit:.0f} s", flush=True)
            continue
        run = median[name]
        ratio = f" ({run['evaluateCpu'] / older['evaluateCpu']:.3f})" if older else ""
        print(f"{title:24} {name:9} {run['evaluate']:8.3f} s, processor"
              f" {run['evaluateCpu']:8.3f} s{ratio}; minimum {run['minimum']:.4f},"
              f" mean {run['mean']:.4f}, {run['inverted']:.0f} inverted;"
              f" {run.get('NewtonSteps', 0):.0f} Newton steps", flush=True)
    return max((run["inverted"] for name, run in median.items() if name != options.against),
               default=math.inf)


def parse_arguments():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--twists", nargs="*", default=TWISTS, metavar="SIDE:DEGREES",
                        help=f"default: {' '.join(TWISTS)}")
    parser.add_argument("--models", nargs="*", default=MODELS, choices=MODELS, metavar="NAME",
                        help=f"default: {' '.join(MODELS)}")
    parser.add_argument("--meshes", nargs="*", default=[], metavar="FILE.vtk",
                        help="files with the point array `fixed`; default: none")
    parser.add_argument("--against", metavar="COMMIT", help="the older commit; default: none")
    parser.add_argument("--older-probe", type=Path, help="the older commit's probe, already built")
    parser.add_argument("--probe", type=Path,
                        default=ROOT / "build" / "paraview" / "bin" / "inversion-free-probe")
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--limit", type=float, default=1800, help="seconds for a run")
    parser.add_argument("--quick", action="store_true", help="small meshes, once: that it runs")
    options = parser.parse_args()
    if options.quick:
        options.repeat, options.models, options.twists = 1, MODELS[:2], ["8:360"]
    return options


def main():
    options = parse_arguments()
    programs = {}
    if options.against:
        programs[options.against] = [options.older_probe or build_older(options.against)]
    for name, steps in EFFORTS.items():
        programs[name] = [options.probe, str(steps)]
    problems = [(f"twist {name}", twist, map(int, name.split(":"))) for name in options.twists]
    problems += [(name, model, [name, options.quick]) for name in options.models]
    problems += [(Path(name).stem, mesh_of, [name]) for name in options.meshes]
    inverted = 0
    with tempfile.TemporaryDirectory() as folder:
        problem = Path(folder) / "problem.bin"
        for title, make, arguments in problems:
            make(*arguments).write(problem)
            inverted += compare(title, problem, programs, options)
    if inverted > 0:
        sys.exit(f"{inverted:.0f} cells are inverted")


if __name__ == "__main__":
    main()
