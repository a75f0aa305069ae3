# SPDX-License-Identifier: BSD-3-Clause
"""Boundaries of the small models: found, moved after their vertices and curves, and projected onto
the true surface.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> pvpython models_boundary.py
"""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np
from paraview import simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader

from boundary_checks import (
    ROOT, Models, SmallBoundaryChecks, number, output, point_array, producer)
from Models.model_mesh import add_array


class BoreHex(SmallBoundaryChecks, unittest.TestCase):
    model, kind = "bore", "hex"


class BoreTet(SmallBoundaryChecks, unittest.TestCase):
    model, kind = "bore", "tet"


class PipeHex(SmallBoundaryChecks, unittest.TestCase):
    model, kind = "pipe", "hex"


class PipeTet(SmallBoundaryChecks, unittest.TestCase):
    model, kind = "pipe", "tet"


class CanisterHex(SmallBoundaryChecks, unittest.TestCase):
    model, kind = "canister", "hex"


class CanisterTet(SmallBoundaryChecks, unittest.TestCase):
    model, kind = "canister", "tet"


class CourierHex(SmallBoundaryChecks, unittest.TestCase):
    model, kind = "courier", "hex"
    angle = 35  # twelve facets around a bore


class CourierTet(SmallBoundaryChecks, unittest.TestCase):
    model, kind = "courier", "tet"
    angle = 40  # a bore's triangles turn by more than 25 degrees


def merged_with_sides(kind):
    """The pipe's volume cells and a face cell for each boundary face, in blocks as the readers of
    Exodus and Gmsh files make them: the cell array Entity numbers the volume and each surface."""
    mesh = Models.get("pipe").read_small(kind)
    volume = mesh.to_vtk()
    for name in ("GeometryDimension", "GeometryId", "CurveParameter"):
        volume.GetPointData().RemoveArray(name)
    add_array(volume.GetCellData(), "Entity", np.full(len(mesh.cells), 500, np.int32))
    sides = mesh.boundary_to_vtk(0)
    add_array(sides.GetCellData(), "Entity", 10 * mesh.face_surface + 7)
    blocks = simple.GroupDatasets(Input=[producer(volume), producer(sides)])
    return mesh, simple.MergeBlocks(
        Input=blocks, MergePoints=1, OutputDataSetType="Unstructured Grid")


def counts(classified):
    return [number(classified, f"NumberOf{what}") for what in ("Vertices", "Curves", "Surfaces")]


class IdsOfSides(unittest.TestCase):
    """Surface ids by cells of dimension two beside the volume cells."""

    def test_from_merged_blocks(self):
        for kind in ("hex", "tet"):
            mesh, merged = merged_with_sides(kind)
            classified = simple.ClassifyBoundary(Input=merged, SurfaceIdArray="Entity")
            self.assertEqual(counts(classified), [0, 8, 8])
            ids = vtk_to_numpy(output(classified, 1).GetCellData().GetArray("GeometryId"))
            expected = np.bincount(mesh.face_surface).tolist()
            self.assertEqual(np.bincount(ids)[7::10].tolist(), expected)
            self.assertEqual(len(ids), len(mesh.faces))

    def test_from_a_gmsh_file(self):
        import gmsh
        with tempfile.TemporaryDirectory() as folder:
            file = str(Path(folder) / "cylinder.vtk")
            gmsh.initialize()
            try:
                gmsh.option.setNumber("General.Terminal", 0)
                gmsh.model.occ.addCylinder(0, 0, 0, 0, 0, 2, 1)
                gmsh.model.occ.synchronize()
                for surface in (1, 2, 3):
                    gmsh.model.addPhysicalGroup(2, [surface], 100 + surface)
                gmsh.model.addPhysicalGroup(3, [1], 500)
                gmsh.option.setNumber("Mesh.CharacteristicLengthMax", 0.3)
                gmsh.model.mesh.generate(3)
                gmsh.write(file)
            finally:
                gmsh.finalize()
            reader = simple.LegacyVTKReader(FileNames=[file])
            classified = simple.ClassifyBoundary(Input=reader, SurfaceIdArray="CellEntityIds")
            self.assertEqual(counts(classified), [0, 2, 3])
            surface = output(classified, 1)
            ids = vtk_to_numpy(surface.GetCellData().GetArray("GeometryId"))
            self.assertEqual(np.unique(ids).tolist(), [101, 102, 103])
            boundary = simple.MorphBoundary(
                Input=classified, Boundary=simple.OutputPort(classified, 1),
                SurfaceIdArray="CellEntityIds", UseGeometryArrays=0)
            self.assertEqual(number(boundary, "FoldedFaces"), 0)
            self.assertEqual(number(boundary, "GivenPoints"), np.count_nonzero(
                point_array(surface, "GeometryDimension") == 1))


class Pictures(unittest.TestCase):
    def test_are_drawn(self):
        with tempfile.TemporaryDirectory() as folder:
            process = subprocess.run(
                ["pvpython", "--force-offscreen-rendering",
                 str(ROOT / "Utilities" / "boundary_picture.py"), "--output", folder],
                capture_output=True, text=True, timeout=200)
            self.assertEqual(process.returncode, 0, process.stderr)
            for name in ("classify-boundary.png", "morph-boundary.png"):
                reader = vtkPNGReader()
                reader.SetFileName(str(Path(folder) / name))
                reader.Update()
                image = reader.GetOutput()
                self.assertEqual(image.GetDimensions()[0], 1600)
                pixels = vtk_to_numpy(image.GetPointData().GetScalars()).astype(int)
                painted = np.count_nonzero(np.ptp(pixels, axis=1) > 30) / len(pixels)
                self.assertGreater(painted, 0.1)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
