# SPDX-License-Identifier: BSD-3-Clause
"""Morphs the bore, as hexahedra and as tetrahedra, and a plate whose hole grows, from the initial
to the final shape with each method, the way a script in an optimization loop would: one filter, a
new boundary each step, the undeformed mesh prepared once.

Run by Utilities/demo.sh, which builds the plugin first, or by hand (a picture needs a display):

    pvpython --force-offscreen-rendering Utilities/demo.py --output demo-output

Writes into the output directory, for each mesh, <name>_before.vtu and FEMWARP's <name>_after.vtu
and <name>.pvd, the series over pseudo-time t = 0 ... 1 for ParaView's time controls; and
bore-femwarp.png. With --picture-each also bore-<method>.png for the other methods. Prints tables of
quality and times: first FEMWARP's, then those of the other methods."""

import argparse
import os
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from paraview import simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import VTK_QUAD, vtkPolyData

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "Data"), str(ROOT / "Utilities")]
from built_plugin import add_plugin, load_plugin  # noqa: E402  (needs the path above)
from demo_picture import Panel, producer, save_picture  # noqa: E402
import Models  # noqa: E402
from Models.model_mesh import ModelMesh, add_array, vtk_points  # noqa: E402
from Models.vtk_files import write_grid, write_pvd  # noqa: E402


@dataclass
class Method:
    """How a method is called in tables, in file names and in pvpython. every_step: whether it is
    fast enough to go through all steps rather than from the first to the last."""

    name: str
    file_name: str
    filter_name: str
    every_step: bool = True


FEMWARP = Method("FEMWARP", "femwarp", "MorphFEMWARP")
METHODS = (
    FEMWARP,
    Method("LBWARP", "lbwarp", "MorphLBWARP"),
    Method("Weighted residual", "weighted-residual", "MorphWeightedResidual"),
    Method("Simplex-linear", "simplex-linear", "MorphSimplexLinear"),
    Method("Simplex-natural neighbor", "simplex-natural-neighbor", "MorphSimplexNaturalNeighbor"),
    Method("Radial basis", "radial-basis", "MorphRadialBasis"),
    Method("Smoothing", "smoothing", "MorphSmoothing", every_step=False),
    Method("Inversion-free", "inversion-free", "MorphInversionFree", every_step=False),
)


@dataclass
class Series:
    """One method's way through one mesh: the filter's output at t = 0 ... 1 or at both ends alone,
    and seconds to prepare and (median) to evaluate."""

    method: Method
    grids: list
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


class Bore:
    """The bore at rest as one mesh, and its displaced boundary, which `move_to` moves."""

    def __init__(self, name, cell_name, mesh):
        self.name, self.cell_name, self.mesh = name, cell_name, mesh
        self.rest = producer(self.mesh.to_vtk())
        boundary = simple.ExtractMorphBoundary(Input=self.rest)
        boundary.UpdatePipeline()
        self.surface = boundary.GetClientSideObject().GetOutputDataObject(0)
        ids = vtk_to_numpy(self.surface.GetPointData().GetArray("MorphPointId"))
        if not np.array_equal(ids, mesh.nodes):
            raise RuntimeError(f"{name}: Extract Morph Boundary found other nodes than the model")
        self.moved = producer(self.surface)

    def move_to(self, t):
        moved = with_positions(self.surface, self.mesh.boundary_positions(t))
        self.moved.GetClientSideObject().SetOutput(moved)
        self.moved.MarkModified(self.moved)


class PlateMesh(ModelMesh):
    """A square plate of quadrilaterals with a round hole, which grows by half of its radius."""

    AROUND, ACROSS, SIDE, RADIUS = 64, 24, 4, 0.5

    def __init__(self):
        angle = 2 * np.pi * np.arange(self.AROUND) / self.AROUND
        ray = np.column_stack([np.cos(angle), np.sin(angle), 0 * angle])
        outline = self.SIDE / 2 / np.abs(ray).max(axis=1)
        part = np.linspace(0, 1, self.ACROSS + 1)[:, None]
        distance = (1 - part) * self.RADIUS + part * outline
        inner = np.arange(self.ACROSS * self.AROUND)
        beside = inner // self.AROUND * self.AROUND + (inner + 1) % self.AROUND
        cells = np.column_stack([inner, inner + self.AROUND, beside + self.AROUND, beside])
        super().__init__((distance[:, :, None] * ray).reshape(-1, 3), cells, VTK_QUAD)
        rim = np.arange(self.AROUND)
        self.nodes = np.concatenate([rim, rim + self.ACROSS * self.AROUND])

    def boundary_positions(self, t):
        positions = self.points[self.nodes]
        positions[:self.AROUND] *= 1 + t / 2
        return positions


class Plate(Bore):
    """The plate at rest. Its boundary is points at the nodes of its edges."""

    def __init__(self):
        self.name, self.cell_name, self.mesh = "plate", "Plane", PlateMesh()
        self.rest = producer(self.mesh.to_vtk())
        self.surface = vtkPolyData()
        self.surface.SetPoints(vtk_points(self.mesh.boundary_positions(0)))
        add_array(self.surface.GetPointData(), "MorphPointId", self.mesh.nodes)
        self.moved = producer(self.surface)


def morph_series(model, method, times):
    """Morphs a model to S_t for each t of `times`, or for the first and the last."""
    if not method.every_step:
        times = [times[0], times[-1]]
    model.move_to(times[0])
    morph = getattr(simple, method.filter_name)(Input=model.rest, Boundary=model.moved)
    if morph.Validity == "Report":
        morph.Validity = "None"  # the table has the inverted cells
    grids = []
    for t in times:
        model.move_to(t)
        morph.UpdatePipeline()
        output_grid = morph.GetClientSideObject().GetOutputDataObject(0)
        if output_grid.GetNumberOfCells() != len(model.mesh.cells):
            raise RuntimeError(f"{model.name}: {method.name} gave no mesh at t = {t}")
        grids.append(output_grid.NewInstance())
        grids[-1].ShallowCopy(output_grid)
    seconds = np.median([number(grid, "EvaluateSeconds") for grid in grids[1:]])
    simple.Delete(morph)  # its weights may be large
    return Series(method, grids, number(grids[0], "PrepareSeconds"), seconds)


def write_series(name, series, times, output):
    """<name>.pvd with a grid for each time, and the first and the last of them by themselves."""
    folder = output / f"{name}_series"
    folder.mkdir(exist_ok=True)
    files = [folder / f"{name}_{step:02d}.vtu" for step in range(len(times))]
    for grid, file in zip(series.grids, files):
        write_grid(grid, file)
    write_pvd(output / f"{name}.pvd", files, times)
    write_grid(series.grids[0], output / f"{name}_before.vtu")
    write_grid(series.grids[-1], output / f"{name}_after.vtu")


COLUMNS = "{:12}{:>8}{:>9}  {:26}{:>8}{:>10}{:>10}{:>11}{:>10}"


def print_head():
    print()
    for head in (
        ("", "", "", "", "scaled", "Jacobian", "inverted", "prepare", "evaluate"),
        ("mesh", "nodes", "cells", "", "min", "mean", "cells", "s", "s"),
    ):
        print(COLUMNS.format(*head))


def print_rows(model, all_series):
    """Quality at rest, and at t = 1 with the seconds of one step, for each method."""

    def row(title, grid, *seconds):
        rest = grid is all_series[0].grids[0]
        print(COLUMNS.format(
            model.cell_name if rest else "",
            f"{grid.GetNumberOfPoints():,}" if rest else "",
            f"{grid.GetNumberOfCells():,}" if rest else "",
            title,
            f"{number(grid, 'MinScaledJacobian'):.4f}",
            f"{number(grid, 'MeanScaledJacobian'):.4f}",
            int(number(grid, "InvertedCells")),
            *(f"{value:.4f}" for value in seconds),
            *([""] * (2 - len(seconds)))), flush=True)

    row("initial shape", all_series[0].grids[0])
    for series in all_series:
        row(series.method.name, series.grids[-1], series.prepare_seconds, series.evaluate_seconds)


def rear_half(mesh):
    """Ids of the cells whose center has y > 0."""
    return np.flatnonzero(mesh.points[mesh.cells].mean(axis=1)[:, 1] > 0)


def panels(model, series):
    cells = rear_half(model.mesh)
    for state, grid in (("before", series.grids[0]), ("after", series.grids[-1])):
        yield Panel(
            f"{model.cell_name}, {state}",
            f"{grid.GetNumberOfCells():,} cells, {int(number(grid, 'InvertedCells'))} inverted\n"
            f"min {number(grid, 'MinScaledJacobian'):.3f}, "
            f"mean {number(grid, 'MeanScaledJacobian'):.3f}",
            grid, cells)


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--output", type=Path, default=Path("demo-output"),
                        help="directory to write to (default: %(default)s)")
    add_plugin(parser)
    parser.add_argument("--steps", type=int, default=20,
                        help="steps from the initial to the final shape (default: %(default)s)")
    parser.add_argument("--no-picture", action="store_true", help="do not render")
    parser.add_argument("--picture-each", action="store_true",
                        help="a picture for each method, not for FEMWARP alone")
    arguments = parser.parse_args()
    if arguments.steps < 1:
        parser.error("--steps must be 1 or more")
    if not arguments.no_picture and not os.environ.get("DISPLAY"):
        parser.error("no display: run under xvfb-run -a, or give --no-picture")
    return arguments


def main():
    arguments = parse_arguments()
    load_plugin(arguments.plugin)
    output = arguments.output.resolve()
    output.mkdir(parents=True, exist_ok=True)

    times = [step / arguments.steps for step in range(arguments.steps + 1)]
    bore = Models.get("bore")
    models = [Bore("bore_hex", "Hexahedra", bore.hex_mesh()),
              Bore("bore_tet", "Tetrahedra", bore.tet_mesh()), Plate()]

    def morph(methods):
        """Morphs all meshes and prints a table; returns the panels of the bore by method."""
        all_panels = {method.file_name: [] for method in methods}
        print_head()
        for model in models:
            all_series = [morph_series(model, method, times) for method in methods]
            print_rows(model, all_series)
            for series in all_series:
                if not isinstance(model, Plate):
                    all_panels[series.method.file_name].extend(panels(model, series))
                if series.method is FEMWARP:
                    write_series(model.name, series, times, output)
        return all_panels

    def picture(method, all_panels):
        path = output / f"bore-{method.file_name}.png"
        save_picture(path, f"{method.name} morphs the bore from its initial to its final shape "
                     "(front half cut away)", all_panels[method.file_name])
        print(f"\nThe picture: {path}", flush=True)

    first = morph([FEMWARP])
    if not arguments.no_picture:
        picture(FEMWARP, first)
    others = [method for method in METHODS if method is not FEMWARP]
    all_panels = morph(others)
    if arguments.picture_each and not arguments.no_picture:
        for method in others:
            picture(method, all_panels)
    print(f"\nWritten to {output}:")
    print("  *.pvd                               FEMWARP in time: open in ParaView and press play")
    print("  *_before.vtu, *_after.vtu           its first and its last mesh")
    if not arguments.no_picture:
        print("  bore-*.png                          pictures")


if __name__ == "__main__":
    main()
