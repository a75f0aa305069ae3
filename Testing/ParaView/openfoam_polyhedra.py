# SPDX-License-Identifier: BSD-3-Clause
"""Polyhedral meshes that OpenFOAM makes here, morphed, and tested by OpenFOAM's checkMesh.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> pvpython openfoam_polyhedra.py
Skipped by name where OpenFOAM is not installed.
"""
import os
import pathlib
import re
import sys
import tempfile
import unittest

from paraview.simple import *
from paraview import servermanager
from vtkmodules.vtkCommonDataModel import VTK_POLYHEDRON

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import foam_case

LoadPlugin(os.environ["MESHMORPHING_PLUGIN"], remote=False, ns=globals())

MISSING = foam_case.missing()


def source_of(data):
    source = TrivialProducer()
    source.GetClientSideObject().SetOutput(data)
    source.UpdatePipeline()
    return source


def morph(source, motion, method):
    """The moved grid, and the status and the number of inverted cells that the method tells."""
    extract = ExtractMorphBoundary(Input=source)
    extract.UpdatePipeline()
    boundary = servermanager.Fetch(extract)
    points = boundary.GetPoints()
    for i in range(points.GetNumberOfPoints()):
        points.SetPoint(i, motion(points.GetPoint(i)))
    filter = method(Input=source, Boundary=source_of(boundary))
    filter.UpdatePipeline()
    grid = servermanager.Fetch(filter)
    field = grid.GetFieldData()
    return (grid, field.GetAbstractArray("MorphStatus").GetValue(0),
            field.GetArray("InvertedCells").GetValue(0))


@unittest.skipIf(MISSING, f"OpenFOAM is not installed (openfoam): {', '.join(MISSING)}")
class OpenFoamPolyhedra(unittest.TestCase):
    """checkMesh's failed checks may only be those that the undeformed mesh fails, non-orthogonality
    and skewness."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.case = foam_case.FoamCase(folder.name)

    def check(self, least):
        """Morphs the case's mesh and has it checked. `least`: number of polyhedra in it."""
        before, output = self.case.check()
        grid = self.case.read()
        polyhedra = sum(grid.GetCellType(c) == VTK_POLYHEDRON
                        for c in range(grid.GetNumberOfCells()))
        self.assertGreaterEqual(polyhedra, least)
        self.assertEqual(grid.GetNumberOfPoints(),
                         int(re.search(r"points:\s+(\d+)", output)[1]))
        source = source_of(grid)
        quality = ScaledJacobian(Input=source,
                                 Criteria="NonOrthogonality, FaceSkewness, FacePyramid")
        quality.UpdatePipeline()
        measured = servermanager.Fetch(quality).GetFieldData()
        worst = measured.GetArray("CriterionWorst")
        for row, printed in enumerate((r"Mesh non-orthogonality Max: (\S+)",
                                       r"Max skewness = ([^, ]+)")):
            expected = float(re.search(printed, output)[1].rstrip("."))
            # ParaView reads the case in single precision.
            self.assertAlmostEqual(worst.GetValue(row) / expected, 1, 5)
        self.assertGreater(worst.GetValue(2), 0)
        self.assertEqual(measured.GetArray("InvertedCells").GetValue(0), 0)
        allowed = before | {"***Number of non-orthogonality errors", "***Max skewness ="}
        for motion in (foam_case.twisted, foam_case.bent, foam_case.waved):
            for method in (MorphInversionFree, MorphFEMWARP):
                with self.subTest(motion=motion.__name__, method=method.__name__):
                    moved, status, inverted = morph(source, motion, method)
                    if motion is foam_case.waved and method is MorphFEMWARP:
                        self.assertGreater(inverted, 0)
                        continue
                    self.assertEqual((status, inverted), ("Valid", 0))
                    self.case.write_points(moved)
                    failed, output = self.case.check()
                    self.assertIn("Cell volumes OK", output)
                    self.assertIn("Face pyramids OK", output)
                    self.assertLessEqual(failed, allowed, output)

    def test_the_dual_of_tetrahedra(self):
        self.case.make_dual(5, 5, 10)
        self.check(least=300)

    def test_hexahedra_refined_around_a_ball_by_snappy_hex_mesh(self):
        self.case.make_refined()
        self.check(least=100)


if __name__ == "__main__":
    unittest.main()
