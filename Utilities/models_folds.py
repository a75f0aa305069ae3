#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""At which of the paper's 20 steps the models' surfaces fold where Morph Boundary moves them after
their exact vertices and curves.

    pvpython Utilities/models_folds.py                  # the small meshes, in Data/Models/small
    pvpython Utilities/models_folds.py --size paper     # of the paper's size: Gmsh, 15 minutes

Prints a table: for each mesh, from the mesh at S_0 at each step (absolute) and from that of the
step before (relative), by weighted residual, as in the paper, and by smoothing, the first step at
which a boundary face is folded, and how many are at S_F. A face is folded where one of its corners
turns against that corner on the exact surfaces."""

import argparse
import sys
from pathlib import Path

import numpy as np
from paraview import simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLogger

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "Data"), str(ROOT / "Utilities")]
from built_plugin import add_plugin, load_plugin  # noqa: E402  (needs the path above)
from demo_picture import producer  # noqa: E402
import Models  # noqa: E402

STEPS = 20
METHODS = ("Weighted residual", "Smoothing")
STEPPINGS = ("absolute", "relative")


def output(proxy, port=0):
    """The data object that a filter made."""
    return proxy.GetClientSideObject().GetOutputDataObject(port)


def corner_normals(corners):
    """(#faces, 3 or 4, 3) along the normal at each corner, from the corners' positions."""
    return np.cross(np.roll(corners, -1, axis=1) - corners, np.roll(corners, 1, axis=1) - corners)


class MovedSurfaces:
    """A model's mesh (ClassifiedMesh) whose boundary Morph Boundary moves after its vertices and
    curves. `filter`: the proxy, whose properties may be set; `moved`: (#nodes, 3) as of the last
    step, interior nodes at rest."""

    def __init__(self, mesh, method=METHODS[0]):
        self.mesh, self.moved = mesh, mesh.points
        self.rest, self.curves = producer(mesh.to_vtk()), producer(mesh.curves_to_vtk(0))
        self.filter = simple.MorphBoundary(
            Input=self.rest, Boundary=self.curves, SurfaceMethod=method)

    def move_to(self, t, relative=False):
        """Gives vertices and curves their place at S_t, and moves the surfaces: from S_0, or with
        `relative` from where they are. Raises RuntimeError where the filter gives no result."""
        curves = self.mesh.curves_to_vtk(t)
        if relative:
            curves.GetPointData().RemoveArray("RestPosition")  # that of S_0
            self._set(self.rest, self.mesh.to_vtk(self.moved))
        self.give(curves)

    def give(self, curves):
        """Moves the surfaces after vertices and curves at these points (vtkPolyData). Raises as
        move_to."""
        self._set(self.curves, curves)
        self.update()

    def update(self):
        """After a property of `filter` was set. Raises as move_to."""
        self.filter.UpdatePipeline()
        surface = output(self.filter)
        if surface.GetNumberOfPoints() != len(self.mesh.nodes):
            raise RuntimeError(f"{self.mesh.model.name}: Morph Boundary gave no boundary")
        self.moved = self.mesh.points.copy()
        ids = vtk_to_numpy(surface.GetPointData().GetArray("MorphPointId"))
        self.moved[ids] = vtk_to_numpy(surface.GetPoints().GetData())

    @staticmethod
    def _set(source, data):
        source.GetClientSideObject().SetOutput(data)
        source.MarkModified(source)

    def folded(self, t):
        """Rows in mesh.faces of the faces with a corner that turns against that of the face's place
        on the exact surface of S_t."""
        here, exact = (corner_normals(points[self.mesh.faces])
                       for points in (self.moved, self.mesh.moved(t)))
        return np.flatnonzero(np.min(np.sum(here * exact, axis=2), axis=1) <= 0)

    def remove(self):
        """Takes the filter and its inputs out of the pipeline."""
        for proxy in (self.filter, self.rest, self.curves):
            simple.Delete(proxy)


def fold_counts(mesh, method, stepping):
    """(STEPS + 1,): how many faces are folded at each step."""
    surfaces = MovedSurfaces(mesh, method)
    counts = []
    for step in range(STEPS + 1):
        surfaces.move_to(step / STEPS, relative=stepping == "relative")
        counts.append(len(surfaces.folded(step / STEPS)))
    surfaces.remove()
    return np.array(counts)


def first_fold(counts):
    """The first step with a folded face, or None."""
    steps = np.flatnonzero(counts)
    return int(steps[0]) if len(steps) else None


def table_head(size):
    titles = [f"{method}, {stepping}" for method in METHODS for stepping in STEPPINGS]
    return (f"| {size} mesh | boundary faces | {' | '.join(titles).lower()} |\n"
            f"|---|---|{'---|' * len(titles)}")


def table_row(mesh, kind):
    cells = []
    for method in METHODS:
        for stepping in STEPPINGS:
            counts = fold_counts(mesh, method, stepping)
            first = first_fold(counts)
            cells.append("none" if first is None else f"step {first}; {counts[-1]:,} at S_F")
    return f"| {mesh.model.name} {kind} | {len(mesh.faces):,} | {' | '.join(cells)} |"


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("models", nargs="*", metavar="MODEL", help="default: all four")
    parser.add_argument("--size", choices=("small", "paper"), default="small",
                        help="default: %(default)s")
    add_plugin(parser)
    arguments = parser.parse_args()
    known = Models.NAMES + Models.VARIANTS
    unknown = [name for name in arguments.models if name not in known]
    if unknown:
        parser.error(f"no model {', '.join(unknown)}: choose from {', '.join(known)}")
    return arguments


def main():
    arguments = parse_arguments()
    load_plugin(arguments.plugin)
    # The filter warns of folded faces at each step.
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_ERROR)
    print(table_head(arguments.size))
    for name in arguments.models or Models.NAMES:
        model = Models.get(name)
        for kind in ("hex", "tet"):
            mesh = model.read_small(kind) if arguments.size == "small" else model.make(kind)
            print(table_row(mesh, kind), flush=True)


if __name__ == "__main__":
    main()
