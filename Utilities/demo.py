# SPDX-License-Identifier: BSD-3-Clause
"""Morphs the bore, as hexahedra and as tetrahedra, from its initial to its final shape with Morph
FEMWARP, the way a script in an optimisation loop would: one filter, a new boundary each step, the
rest mesh prepared once.

Run by Utilities/demo.sh, which builds the plugin first, or by hand (a picture needs a display):

    pvpython --force-offscreen-rendering Utilities/demo.py --output demo-output

Writes into the output directory, for each mesh, <name>_before.vtu, <name>_after.vtu and <name>.pvd,
the series over pseudo-time t = 0 ... 1 for ParaView's time controls; and bore-femwarp.png. Prints a
table of quality and times."""

import argparse
import os
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from paraview import simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "Data"), str(ROOT / "Utilities")]
from demo_picture import Panel, producer, save_picture  # noqa: E402  (needs the path above)
import Models  # noqa: E402
from Models.model_mesh import vtk_points  # noqa: E402
from Models.vtk_files import write_grid, write_pvd  # noqa: E402


@dataclass
class Series:
    """One mesh's way: the filter's output at t = 0 and t = 1, and seconds to prepare and (median)
    to evaluate."""

    cell_name: str
    before: vtkUnstructuredGrid
    after: vtkUnstructuredGrid
    prepare_seconds: float
    evaluate_seconds: float


def number(grid, name):
    """A number that the filter wrote as field data."""
    return grid.GetFieldData().GetArray(name).GetValue(0)


def with_positions(surface, positions):
    """A copy of the polydata `surface` with other points, and its arrays (MorphPointId,
    RestPosition) along."""
    moved = surface.NewInstance()
    moved.ShallowCopy(surface)
    moved.SetPoints(vtk_points(positions))
    return moved


def morph_series(name, cell_name, mesh, steps, output):
    """Morphs a model's mesh to S_t for t = 0, 1/steps, ..., 1 and writes every grid."""
    rest = producer(mesh.to_vtk())
    boundary = simple.ExtractMorphBoundary(Input=rest)
    boundary.UpdatePipeline()
    surface = boundary.GetClientSideObject().GetOutputDataObject(0)
    ids = vtk_to_numpy(surface.GetPointData().GetArray("MorphPointId"))
    if not np.array_equal(ids, mesh.nodes):
        raise RuntimeError(f"{name}: Extract Morph Boundary found other nodes than the model")

    moved = producer(surface)
    morph = simple.MorphFEMWARP(Input=rest, Boundary=moved)
    folder = output / f"{name}_series"
    folder.mkdir(exist_ok=True)
    times = [step / steps for step in range(steps + 1)]
    grids, files = [], []
    for step, t in enumerate(times):
        positions = mesh.boundary_positions(t)
        moved.GetClientSideObject().SetOutput(with_positions(surface, positions))
        moved.MarkModified(moved)
        morph.UpdatePipeline()
        output_grid = morph.GetClientSideObject().GetOutputDataObject(0)
        if output_grid.GetNumberOfCells() != len(mesh.cells):
            raise RuntimeError(f"{name}: Morph FEMWARP gave no mesh at t = {t}")
        grids.append(output_grid.NewInstance())
        grids[-1].ShallowCopy(output_grid)
        files.append(folder / f"{name}_{step:02d}.vtu")
        write_grid(grids[-1], files[-1])

    write_pvd(output / f"{name}.pvd", files, times)
    write_grid(grids[0], output / f"{name}_before.vtu")
    write_grid(grids[-1], output / f"{name}_after.vtu")
    seconds = np.median([number(grid, "EvaluateSeconds") for grid in grids[1:]])
    return Series(cell_name, grids[0], grids[-1], number(grids[0], "PrepareSeconds"), seconds)


def print_table(all_series):
    """Quality at t = 0 and t = 1; seconds and solver iterations of one step."""
    columns = "{:12}{:>9}{:>10}  {:8}{:>8}{:>10}{:>10}{:>11}{:>12}{:>12}"
    print()
    for head in (
        ("", "", "", "", "scaled", "Jacobian", "inverted", "prepare", "evaluate", ""),
        ("mesh", "nodes", "cells", "shape", "min", "mean", "cells", "s", "s", "iterations"),
    ):
        print(columns.format(*head))
    for series in all_series:
        for shape, grid in (("initial", series.before), ("final", series.after)):
            first = grid is series.before
            print(columns.format(
                series.cell_name if first else "",
                f"{grid.GetNumberOfPoints():,}" if first else "",
                f"{grid.GetNumberOfCells():,}" if first else "",
                shape,
                f"{number(grid, 'MinScaledJacobian'):.4f}",
                f"{number(grid, 'MeanScaledJacobian'):.4f}",
                int(number(grid, "InvertedCells")),
                "" if first else f"{series.prepare_seconds:.3f}",
                "" if first else f"{series.evaluate_seconds:.3f}",
                "" if first else int(number(grid, "SolverIterations"))))
    print()


def rear_half(mesh):
    """Ids of the cells whose centre has y > 0."""
    return np.flatnonzero(mesh.points[mesh.cells].mean(axis=1)[:, 1] > 0)


def panels(series, mesh):
    cells = rear_half(mesh)
    for state, grid in (("before", series.before), ("after", series.after)):
        yield Panel(
            f"{series.cell_name}, {state}",
            f"{grid.GetNumberOfCells():,} cells, {int(number(grid, 'InvertedCells'))} inverted\n"
            f"min {number(grid, 'MinScaledJacobian'):.3f}, "
            f"mean {number(grid, 'MeanScaledJacobian'):.3f}",
            grid, cells)


def find_plugin(given):
    if given:
        return Path(given)
    built = sorted((ROOT / "build" / "paraview").glob("**/MeshMorphing.so"))
    if not built:
        sys.exit("demo: no MeshMorphing.so under build/paraview: run demo.sh, or use --plugin")
    return built[0]


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--output", type=Path, default=Path("demo-output"),
                        help="directory to write to (default: %(default)s)")
    parser.add_argument("--plugin", default=os.environ.get("MESHMORPHING_PLUGIN"),
                        help="default: $MESHMORPHING_PLUGIN, or the one under build/paraview")
    parser.add_argument("--steps", type=int, default=20,
                        help="steps from the initial to the final shape (default: %(default)s)")
    parser.add_argument("--no-picture", action="store_true", help="do not render")
    arguments = parser.parse_args()
    if arguments.steps < 1:
        parser.error("--steps must be 1 or more")
    if not arguments.no_picture and not os.environ.get("DISPLAY"):
        parser.error("no display: run under xvfb-run -a, or give --no-picture")
    return arguments


def main():
    arguments = parse_arguments()
    simple.LoadPlugin(str(find_plugin(arguments.plugin)), remote=False, ns=vars(simple))
    output = arguments.output.resolve()
    output.mkdir(parents=True, exist_ok=True)

    bore = Models.get("bore")
    all_series, all_panels = [], []
    for name, cell_name, make in (
        ("bore_hex", "Hexahedra", bore.hex_mesh),
        ("bore_tet", "Tetrahedra", bore.tet_mesh),
    ):
        mesh = make()
        series = morph_series(name, cell_name, mesh, arguments.steps, output)
        all_series.append(series)
        all_panels.extend(panels(series, mesh))
    print_table(all_series)

    if not arguments.no_picture:
        save_picture(
            output / "bore-femwarp.png",
            "FEMWARP morphs the bore from its initial to its final shape (front half cut away)",
            all_panels)
    print(f"Written to {output}:")
    print("  bore_hex.pvd, bore_tet.pvd          series in time: open in ParaView and press play")
    print("  bore_*_before.vtu, bore_*_after.vtu the first and the last mesh")
    if not arguments.no_picture:
        print("  bore-femwarp.png                    the picture")


if __name__ == "__main__":
    main()
