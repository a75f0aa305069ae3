# SPDX-License-Identifier: BSD-3-Clause
"""How fast the mesh follows a boundary that is dragged in ParaView: from the change of a parameter
upstream to the finished picture, and where the time goes. Median of several drags after the first,
which prepares the method. With --surface: with the output Surface in place of the mesh, beside the
floor, the same view of a surface of that size whose points change. --fade: the boundary fades
instead of following. --outer: only the cells behind the surface are measured. With --shapes: from a
changed weight of Morph Shapes to the picture of its output Surface, beside the floor. With
--morph-mesh: from a box dragged as Live Drag does it. --keep writes what pages quote into
Testing/Benchmark/results/dragging.csv, in place of earlier rows of the same.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> xvfb-run -a -s "-screen 0 1280x1024x24" \\
         pvpython Utilities/benchmark_live.py [--cells 50] [--drags 7] \\
         [--methods FEMWARP,LBWARP] [--upstream Transform] [--surface] [--shapes]
"""
import argparse
import csv
import os
import statistics
import sys
import time
from pathlib import Path

import numpy as np
from paraview import simple
from vtkmodules.util.numpy_support import (numpy_to_vtk, numpy_to_vtkIdTypeArray,
                                           vtk_to_numpy)
from vtkmodules.vtkCommonCore import vtkPoints, vtkSMPTools
from vtkmodules.vtkCommonDataModel import (VTK_HEXAHEDRON, vtkCellArray, vtkPolyData,
                                           vtkUnstructuredGrid)

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "Utilities"))
from study_pieces import ORIGIN, origin  # noqa: E402  (needs the path above)

simple.LoadPlugin(os.environ["MESHMORPHING_PLUGIN"], remote=False, ns=globals())

TABLE = ROOT / "Testing/Benchmark/results/dragging.csv"
#: Times are in milliseconds; picture: from the drag to the finished picture.
FIELDS = ("nodes", "paraview", "dragged", "evaluate_ms", "rest_of_filter_ms", "picture_ms",
          "floor_ms", *ORIGIN)

# SimplexNaturalNeighbor is left out: on this regular grid its weights take more than a minute.
METHODS = "FEMWARP", "LBWARP", "WeightedResidual", "SimplexLinear"
COLUMNS = ("boundary", "prepare", "evaluate", "rest of filter", "surface", "render",
           "drag to picture")

SURFACE_COLUMNS = ("boundary", "evaluate", "rest of filter", "render", "drag to picture", "floor")


def keep(nodes, dragged, evaluate, rest, picture, floor):
    """Writes a row, in place of one of the same three first fields. Times are in seconds; an
    empty one was not measured."""
    with open(TABLE, newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))[1:]
    key = [str(nodes), str(simple.GetParaViewVersion()), dragged]
    times = (seconds and f"{1e3 * seconds:.1f}" for seconds in (evaluate, rest, picture, floor))
    rows = [row for row in rows if row[:3] != key] + [[*key, *times, *origin()]]
    with open(TABLE, "w", newline="", encoding="utf-8") as file:
        csv.writer(file, lineterminator="\n").writerows([FIELDS, *rows])


def cube(cells):
    """cells^3 hexahedra in the unit cube."""
    n = cells + 1
    z, y, x = np.meshgrid(*[np.linspace(0, 1, n)] * 3, indexing="ij")
    first = (np.arange(n ** 3).reshape(n, n, n)[:-1, :-1, :-1]).ravel()
    corners = np.array([0, 1, n + 1, n, n * n, n * n + 1, n * n + n + 1, n * n + n])
    nodes = (first[:, None] + corners).ravel()
    points, array, grid = vtkPoints(), vtkCellArray(), vtkUnstructuredGrid()
    points.SetData(numpy_to_vtk(np.stack([x.ravel(), y.ravel(), z.ravel()], axis=1), deep=True))
    array.SetData(numpy_to_vtkIdTypeArray(np.arange(0, len(nodes) + 1, 8), deep=True),
                  numpy_to_vtkIdTypeArray(nodes, deep=True))
    grid.SetPoints(points)
    grid.SetCells(VTK_HEXAHEDRON, array)
    return grid


def seconds(action):
    start = time.perf_counter()
    action()
    return time.perf_counter() - start


class Drag:
    """A boundary and what moves it.

    `move` makes step i's motion, with the boundary's top turned and lifted a bit more."""

    def __init__(self, part, upstream, surroundings="Follow"):
        if upstream == "Transform":
            self.moved = simple.Transform(Input=ExtractMorphBoundary(Input=part))
        else:
            self.moved = BoundaryDisplacement(Input=part, Moving="Region", Region="Box",
                                              Surroundings=surroundings)
            self.moved.Region.Position = [-0.1, -0.1, 0.9]
            self.moved.Region.Length = [1.2, 1.2, 0.2]
        self.transform = self.moved.Transform

    def move(self, step):
        self.transform.Translate = [0, 0, 0.01 * (step + 1)]
        self.transform.Rotate = [0, 0, 1.0 * (step + 1)]


def measure(method, part, drag, drags):
    """Medians of the columns, and the number of preparations and the first drag's seconds."""
    morph = globals()["Morph" + method](Input=part, Boundary=drag.moved)
    view = simple.CreateRenderView(ViewSize=[1000, 800])
    display = simple.Show(morph, view)
    simple.Show(simple.OutputPort(morph, 1), view)
    display.SetRepresentationType("Surface")
    drag.move(-1)
    first = seconds(lambda: simple.Render(view))
    prepare = morph.PrepareSeconds
    surface = simple.ExtractSurface(Input=morph)
    surface.UpdatePipeline()
    rows = []
    for step in range(drags):
        drag.move(2 * step)
        total = seconds(lambda: simple.Render(view))
        drag.move(2 * step + 1)
        boundary = seconds(drag.moved.UpdatePipeline)
        whole = seconds(morph.UpdatePipeline)
        extraction = seconds(surface.UpdatePipeline)
        picture = seconds(lambda: simple.Render(view))
        rows.append((boundary, morph.PrepareSeconds, morph.EvaluateSeconds,
                     whole - morph.PrepareSeconds - morph.EvaluateSeconds, extraction,
                     picture - extraction, total))
    count = morph.PrepareCount
    simple.Delete(surface)
    simple.Delete(view)
    simple.Delete(morph)
    return [statistics.median(column) for column in zip(*rows)], count, first, prepare


def measure_surface(method, part, drag, drags, quality):
    """Medians of the columns of --surface."""
    morph = globals()["Morph" + method](Input=part, Boundary=drag.moved, Quality=quality)
    view = simple.CreateRenderView(ViewSize=[1000, 800])
    simple.Show(simple.OutputPort(morph, "Surface"), view)
    drag.move(-1)
    simple.Render(view)
    rows = []
    for step in range(drags):
        drag.move(step)
        boundary = seconds(drag.moved.UpdatePipeline)
        whole = seconds(morph.UpdatePipeline)
        picture = seconds(lambda: simple.Render(view))
        rows.append((boundary, morph.EvaluateSeconds, whole - morph.EvaluateSeconds, picture,
                     boundary + whole + picture))
    surface = morph.GetClientSideObject().GetOutputDataObject(2)
    medians = [statistics.median(column) for column in zip(*rows)]
    simple.Delete(view)
    return medians + [measure_floor(surface, drags)]


def measure_floor(surface, drags):
    """The median time of a picture of a surface whose points change each time."""
    moving = vtkPolyData()
    moving.ShallowCopy(surface)
    rest = vtk_to_numpy(surface.GetPoints().GetData()).copy()
    source = simple.TrivialProducer()
    source.GetClientSideObject().SetOutput(moving)
    view = simple.CreateRenderView(ViewSize=[1000, 800])
    simple.Show(source, view)
    times = []
    for step in range(drags + 1):
        points = vtkPoints()
        points.SetData(numpy_to_vtk(rest * (1 + 0.001 * step), deep=True))
        moving.SetPoints(points)
        source.MarkModified(source)
        times.append(seconds(lambda: simple.Render(view)))
    simple.Delete(view)
    simple.Delete(source)
    return statistics.median(times[1:])


def warm_up(part, drags):
    """Draws in a view before any figure is taken: pictures of a process's first view take longer,
    whatever it shows. A floor from a later view would look too low beside them."""
    measure_floor(simple.servermanager.Fetch(simple.ExtractSurface(Input=part)), drags)


def drag_to_picture(filter_, move, drags):
    """Medians of its evaluation, the rest of it, the picture of its Surface and all of these; then
    the floor, and the first picture. move(i): changes the filter for step i."""
    view = simple.CreateRenderView(ViewSize=[1000, 800])
    simple.Show(simple.OutputPort(filter_, "Surface"), view)
    first = seconds(lambda: simple.Render(view))
    rows = []
    for step in range(drags):
        move(step)
        whole = seconds(filter_.UpdatePipeline)
        picture = seconds(lambda: simple.Render(view))
        filter_.UpdatePropertyInformation()
        evaluate = filter_.EvaluateSeconds
        rows.append((evaluate, whole - evaluate, picture, whole + picture))
    surface = filter_.GetClientSideObject().GetOutputDataObject(2)
    medians = [statistics.median(column) for column in zip(*rows)]
    simple.Delete(view)
    return medians + [measure_floor(surface, drags), first]


def measure_shapes(part, drags):
    """Medians of the columns of --shapes."""
    boundary = ExtractMorphBoundary(Input=part)
    shapes = [simple.Calculator(Input=boundary, Function=function, CoordinateResults=1)
              for function in ("coords + 0.1*coordsZ*coordsX*iHat",
                               "coords + 0.1*coordsZ*coordsY*coordsY*jHat",
                               "coords + 0.05*coordsX*kHat")]
    blend = MorphShapes(Input=part, Shapes=shapes, Weights=[0, 0, 0], Quality="Surface",
                        FindValidRanges=0)
    def weigh(step):
        blend.Weights = [0.02 * (step + 1), 0.5, -0.5]

    return drag_to_picture(blend, weigh, drags)


def measure_morph_mesh(part, surroundings, drags):
    """Medians of the columns of --morph-mesh."""
    morph = MorphMesh(Input=part, Moving="Region", Region="Box", Surroundings=surroundings,
                      Live=1, Quality="Surface")
    morph.Region.Position = [-0.1, -0.1, 0.9]
    morph.Region.Length = [1.2, 1.2, 0.2]
    def drag(step):
        morph.Transform.Translate = [0, 0, 0.002 * (step + 1)]
        morph.Transform.Rotate = [0, 0, 0.2 * (step + 1)]

    return drag_to_picture(morph, drag, drags)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cells", type=int, default=50, help="cells along an edge of the cube")
    parser.add_argument("--drags", type=int, default=7)
    parser.add_argument("--methods", default=",".join(METHODS))
    parser.add_argument("--upstream", choices=("Transform", "BoundaryDisplacement"),
                        default="Transform")
    parser.add_argument("--surface", action="store_true", help="show Surface, not the mesh")
    parser.add_argument("--fade", action="store_true", help="with --surface and Boundary"
                        "Displacement: the sides fade; they follow otherwise")
    parser.add_argument("--outer", action="store_true",
                        help="with --surface: measure the cells behind the surface alone")
    parser.add_argument("--shapes", action="store_true")
    parser.add_argument("--morph-mesh", action="store_true")
    parser.add_argument("--keep", action="store_true", help="write the rows that pages quote")
    options = parser.parse_args()
    grid = cube(options.cells)
    part = simple.TrivialProducer()
    part.GetClientSideObject().SetOutput(grid)
    nodes = grid.GetNumberOfPoints()
    print(f"{nodes:,} nodes, {grid.GetNumberOfCells():,} hexahedra; "
          f"milliseconds; {options.upstream}; "
          f"VTK's threads: {vtkSMPTools.GetBackend()}, cores: {os.cpu_count()}")
    warm_up(part, options.drags)
    if options.shapes:
        names = ("blend", "rest of filter", "render", "weight to picture", "floor", "first")
        print("".join(f"{name:>20}" for name in names))
        medians = measure_shapes(part, options.drags)
        print("".join(f"{1e3 * m:20.1f}" for m in medians))
        if options.keep:
            evaluate, rest, _, picture, floor, _ = medians
            keep(nodes, "Morph Shapes, three weights", evaluate, rest, picture, floor)
        return
    if options.morph_mesh:
        names = ("evaluate", "rest of filter", "render", "box to picture", "floor", "first")
        print(f"{'':12}" + "".join(f"{name:>20}" for name in names))
        for surroundings in ("Follow", "Fade", "Stay"):
            medians = measure_morph_mesh(part, surroundings, options.drags)
            print(f"{surroundings:12}" + "".join(f"{1e3 * m:20.1f}" for m in medians), flush=True)
            if options.keep:
                evaluate, rest, _, picture, floor, _ = medians
                keep(nodes, f"Morph Mesh's box, *{surroundings}*", evaluate, rest, picture, floor)
        return
    if options.surface:
        print(f"{'':24}" + "".join(f"{name:>16}" for name in SURFACE_COLUMNS))
        for method in options.methods.split(","):
            drag = Drag(part, options.upstream, "Fade" if options.fade else "Follow")
            medians = measure_surface(method, part, drag, options.drags,
                                      "Surface" if options.outer else "All")
            print(f"{method:24}" + "".join(f"{1e3 * m:16.1f}" for m in medians), flush=True)
            if options.keep:
                _, evaluate, rest, _, picture, floor = medians
                keep(nodes, f"Morph {method}, its surface", evaluate, rest, picture, floor)
        return
    print(f"{'':24}" + "".join(f"{name:>16}" for name in COLUMNS)
          + f"{'prepared':>10}{'first':>10}")
    for method in options.methods.split(","):
        drag = Drag(part, options.upstream)
        medians, count, first, prepare = measure(method, part, drag, options.drags)
        print(f"{method:24}" + "".join(f"{1e3 * m:16.1f}" for m in medians)
              + f"{count:>10.0f}{1e3 * first:10.0f}"
              f"   (of it prepare {1e3 * prepare:.0f})", flush=True)
        if options.keep:
            keep(nodes, f"Morph {method}, the mesh", medians[2], medians[3], medians[-1], "")


if __name__ == "__main__":
    main()
