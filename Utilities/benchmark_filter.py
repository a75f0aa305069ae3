# SPDX-License-Identifier: BSD-3-Clause
"""What a morph costs through ParaView's filter, by the size of the mesh, for one plugin or several.

    pvpython Utilities/benchmark_filter.py 50 100 200
    pvpython Utilities/benchmark_filter.py 100 --plugin now=a/MeshMorphing.so then=b/MeshMorphing.so

The mesh is a cube of N x N x N hexahedra whose outer nodes turn about an axis by up to 45 degrees.
A cold run has topology, preparation, solution, quality and output; a warm one follows when the
boundary moves again. Each plugin runs in a process of its own, in turn, so that a slow spell of the
machine falls on all. Prints medians of seconds, the memory beside the mesh and its output's
connectivity, and the first plugin's figures over the others'. Solver tolerance: 1e-8."""

import argparse
import ctypes
import json
import os
import statistics
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TOLERANCE = 1e-8
COLUMNS = ("cold", "warm", "memory")


def cube(side):
    """A cube of side^3 hexahedra, as a vtkUnstructuredGrid."""
    import numpy as np
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import (VTK_HEXAHEDRON, vtkCellArray, vtkUnstructuredGrid)
    sys.path.insert(0, str(ROOT / "Testing" / "Benchmark"))
    from large_cube import boundary, plane_of_cells, plane_of_points
    nodes = np.empty((side ** 3, 8), np.int64)
    for k in range(side):
        nodes[k * side ** 2:(k + 1) * side ** 2] = plane_of_cells(side, k)
    points, cells, grid = vtkPoints(), vtkCellArray(), vtkUnstructuredGrid()
    points.SetData(numpy_to_vtk(
        np.concatenate([plane_of_points(side, k) for k in range(side + 1)]), deep=True))
    cells.SetData(numpy_to_vtkIdTypeArray(np.arange(0, nodes.size + 1, 8), deep=True),
                  numpy_to_vtkIdTypeArray(nodes.ravel(), deep=True))
    grid.SetPoints(points)
    grid.SetCells(VTK_HEXAHEDRON, cells)
    return grid, *boundary(side)


def turned(places, degrees):
    import numpy as np
    angle = np.radians(degrees) * places[:, 2]
    x, y = places[:, 0] - 0.5, places[:, 1] - 0.5
    return np.column_stack([0.5 + x * np.cos(angle) - y * np.sin(angle),
                            0.5 + x * np.sin(angle) + y * np.cos(angle), places[:, 2]])


def status(name):
    """Bytes of a line of /proc/self/status."""
    for line in Path("/proc/self/status").read_text(encoding="ascii").splitlines():
        if line.startswith(f"{name}:"):
            return int(line.split()[1]) * 1024
    sys.exit(f"/proc/self/status has no {name}")


def measure(plugin, side, method, repeat):
    """In a process of its own: seconds cold, median seconds warm, bytes beside the grid."""
    from paraview import simple
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkPolyData
    simple.LoadPlugin(plugin, remote=False, ns=vars(simple))
    grid, ids, places = cube(side)
    moved = vtkPolyData()
    numbers = numpy_to_vtkIdTypeArray(ids, deep=True)
    numbers.SetName("MorphPointId")
    moved.GetPointData().AddArray(numbers)

    mesh, boundary = simple.TrivialProducer(), simple.TrivialProducer()
    mesh.GetClientSideObject().SetOutput(grid)

    def move(degrees):
        points = vtkPoints()
        points.SetData(numpy_to_vtk(turned(places, degrees), deep=True))
        moved.SetPoints(points)
        boundary.GetClientSideObject().SetOutput(moved)
        boundary.MarkModified(boundary)

    move(45)
    morph = getattr(simple, f"Morph{method}")(Input=mesh, Boundary=boundary)
    if "Tolerance" in morph.ListProperties():
        morph.Tolerance = TOLERANCE
    ctypes.CDLL(None).malloc_trim(0)  # what was freed would be used again without a new peak
    Path("/proc/self/clear_refs").write_text("5", encoding="ascii")  # VmHWM starts again
    before = status("VmRSS")
    seconds = []
    for step in range(1 + repeat):
        move(45 - step)
        start = time.perf_counter()
        morph.UpdatePipeline()
        seconds.append(time.perf_counter() - start)
        output = morph.GetClientSideObject().GetOutputDataObject(0)
        if output.GetNumberOfPoints() != grid.GetNumberOfPoints():
            sys.exit(f"{plugin}: no result")
    peak = status("VmHWM")
    print(json.dumps({"cold": seconds[0], "warm": statistics.median(seconds[1:]),
                      "memory": peak - before, "nodes": grid.GetNumberOfPoints()}))


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sides", nargs="+", type=int, metavar="N", help="cells a side")
    parser.add_argument("--plugin", nargs="+", metavar="NAME=FILE", default=[],
                        help="default: the one under build/paraview")
    parser.add_argument("--methods", default="FEMWARP,LBWARP")
    parser.add_argument("--repeat", type=int, default=3, help="warm runs, and processes of each")
    parser.add_argument("--one", nargs=2, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.one:
        plugin, method = options.one
        measure(plugin, options.sides[0], method, options.repeat)
        return
    built = sorted((ROOT / "build" / "paraview" / "lib").glob("**/MeshMorphing.so"))
    plugins = dict(text.split("=", 1) for text in options.plugin) or {"now": str(built[0])}
    print(f"{'nodes':>10} {'method':16} {'plugin':8} {'cold s':>8} {'warm s':>8} {'MB':>8} "
          f"{'B/node':>8}")
    for side in options.sides:
        for method in options.methods.split(","):
            runs = {name: [] for name in plugins}
            for _ in range(1 if side >= 200 else options.repeat):
                for name, plugin in plugins.items():
                    done = subprocess.run(
                        ["pvpython", __file__, str(side), "--one", plugin, method,
                         "--repeat", str(options.repeat)],
                        check=True, text=True, stdout=subprocess.PIPE,
                        env=dict(os.environ, VTK_SMP_BACKEND_IN_USE="STDThread"))
                    runs[name].append(json.loads(done.stdout.strip().splitlines()[-1]))
            medians = {name: {key: statistics.median(run[key] for run in found)
                              for key in COLUMNS} for name, found in runs.items()}
            nodes = next(iter(runs.values()))[0]["nodes"]
            for name, figures in medians.items():
                print(f"{nodes:>10} {method:16} {name:8} {figures['cold']:8.3f} "
                      f"{figures['warm']:8.3f} {figures['memory'] / 1e6:8.0f} "
                      f"{figures['memory'] / nodes:8.0f}", flush=True)
            first, *others = medians
            for other in others:
                print(f"{'':27} {first} / {other}: " + ", ".join(
                    f"{key} {medians[first][key] / medians[other][key]:.2f}" for key in COLUMNS),
                    flush=True)


if __name__ == "__main__":
    main()
