#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""How many faces of the models' surfaces fold where Morph Boundary moves them after their exact
vertices and curves.

    pvpython Utilities/models_folds.py    # 15 minutes, most of it Gmsh's

Writes Documentation/Study/folds.csv: for the small meshes and those of the paper's size, the faces
that are folded at S_F, from the mesh at S_0 (absolute) or in 20 steps, each from the mesh of the
one before (relative). A face is folded if one of its corners turns against that corner on the exact
surfaces."""

import argparse
import csv
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
from study_paper import STEPS  # noqa: E402
from study_pieces import commit  # noqa: E402
import Models  # noqa: E402

DATA = ROOT / "Documentation" / "Study" / "folds.csv"
METHODS = ("Weighted residual", "Smoothing")
#: Weighted residual is the paper's method, and the paper has both steppings.
SERIES = ((METHODS[0], "absolute"), (METHODS[0], "relative"), (METHODS[1], "absolute"),
          ("Mesh smoothing", "absolute"))
FIELDS = ("size", "model", "kind", "nodes", "cells", "boundary_faces", "method", "stepping",
          "folded", "commit")


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


def folds(mesh, method, stepping):
    """How many faces are folded at S_F."""
    surfaces = MovedSurfaces(mesh, method)
    for step in range(1, STEPS + 1) if stepping == "relative" else [STEPS]:
        surfaces.move_to(step / STEPS, relative=stepping == "relative")
    count = len(surfaces.folded(1))
    surfaces.remove()
    return count


def rows(mesh, size, kind):
    """Yields a row of the data file for each series."""
    about = {"size": size, "model": mesh.model.name, "kind": kind, "nodes": len(mesh.points),
             "cells": len(mesh.cells), "boundary_faces": len(mesh.faces), "commit": commit()}
    for method, stepping in SERIES:
        yield {**about, "method": method, "stepping": stepping,
               "folded": folds(mesh, method, stepping)}


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    add_plugin(parser)
    load_plugin(parser.parse_args().plugin)
    # The filter warns of folded faces at each step.
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_ERROR)
    with open(DATA, "w", encoding="utf-8", newline="") as file:
        table = csv.DictWriter(file, FIELDS, lineterminator="\n")
        table.writeheader()
        for size in ("small", "paper"):
            for name in Models.NAMES:
                model = Models.get(name)
                for kind in ("hex", "tet"):
                    mesh = model.read_small(kind) if size == "small" else model.make(kind)
                    table.writerows(rows(mesh, size, kind))
                    file.flush()


if __name__ == "__main__":
    main()
