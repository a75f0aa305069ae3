# SPDX-License-Identifier: BSD-3-Clause
"""The Scaled Jacobian filter as a pvpython script uses it: numbers, colors, properties.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> pvpython scaled_jacobian.py
"""
import math
import os
import sys
import tempfile
import unittest

from paraview.simple import *
from paraview import servermanager
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import VTK_HEXAHEDRON, vtkUnstructuredGrid

LoadPlugin(os.environ["MESHMORPHING_PLUGIN"], remote=False, ns=globals())


def hexes(shear, inverted):
    """Two separate pairs of unit cubes in one grid: one sheared along x by `shear`, one whose
    second cube has its last corner pushed through the bottom if `inverted`."""
    points, grid = vtkPoints(), vtkUnstructuredGrid()
    points.SetDataTypeToDouble()
    lattice = {}

    def node(i, j, k, offset):
        key = (i, j, k, offset)
        if key not in lattice:
            x, z = i + offset, float(k)
            if offset:
                x += shear * k
            elif inverted and (i, j, k) == (2, 1, 1):
                z = -1.0
            lattice[key] = points.InsertNextPoint(x, j, z)
        return lattice[key]

    for offset in (0, 10):
        for i in (0, 1):
            ids = [node(i + a, b, c, offset)
                   for a, b, c in ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0),
                                   (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))]
            grid.InsertNextCell(VTK_HEXAHEDRON, 8, ids)
    grid.SetPoints(points)
    return grid


def source(grid):
    producer = TrivialProducer()
    producer.GetClientSideObject().SetOutput(grid)
    producer.UpdatePipeline()
    return producer


class ScaledJacobianTest(unittest.TestCase):
    def test_numbers_in_panel_and_field_data(self):
        quality = ScaledJacobian(Input=source(hexes(1.0, True)))
        quality.UpdatePipeline()
        quality.UpdatePropertyInformation()
        output = servermanager.Fetch(quality)
        values = output.GetCellData().GetArray("ScaledJacobian")
        self.assertAlmostEqual(values.GetValue(0), 1.0, places=14)
        self.assertLess(values.GetValue(1), 0.0)
        self.assertAlmostEqual(values.GetValue(2), math.sqrt(0.5), places=14)
        self.assertEqual(output.GetCellData().GetScalars().GetName(), "ScaledJacobian")

        self.assertEqual(quality.MinScaledJacobian, values.GetValue(1))
        self.assertAlmostEqual(quality.MeanScaledJacobian,
                               sum(values.GetValue(c) for c in range(4)) / 4, places=14)
        self.assertEqual(quality.MeasuredCells, 4)
        self.assertEqual(quality.InvertedCells, 1)
        self.assertEqual(quality.DegenerateCells, 0)
        self.assertEqual(quality.WorstCellId, 1)
        self.assertEqual(quality.UnmeasuredCells, 0)
        self.assertEqual(quality.MirroredBodies, 0)
        for name in ("MinScaledJacobian", "MeanScaledJacobian", "InvertedCells", "DegenerateCells",
                     "WorstCellId", "MirroredBodies"):
            self.assertEqual(output.GetFieldData().GetArray(name).GetTuple1(0),
                             getattr(quality, name), name)

    def test_certificate(self):
        quality = ScaledJacobian(Input=source(hexes(1.0, True)))
        self.assertEqual(quality.Certify, 0)
        quality.UpdatePipeline()
        data = servermanager.Fetch(quality).GetCellData()
        self.assertIsNone(data.GetArray("JacobianCertificate"))
        quality.Certify = 1
        quality.UpdatePipeline()
        quality.UpdatePropertyInformation()
        output = servermanager.Fetch(quality)
        values = output.GetCellData().GetArray("JacobianCertificate")
        self.assertEqual([values.GetTuple1(c) for c in range(4)], [1, -1, 1, 1])
        self.assertEqual(output.GetCellData().GetScalars().GetName(), "ScaledJacobian")
        for name, count in (("CertifiedCells", 3), ("UncertifiedCells", 1), ("UndecidedCells", 0)):
            self.assertEqual(output.GetFieldData().GetArray(name).GetTuple1(0), count, name)
            self.assertEqual(getattr(quality, name), count, name)

    def test_criteria(self):
        quality = ScaledJacobian(Input=source(hexes(1.0, False)), Criteria="Skewness=.4, Warpage")
        quality.UpdatePipeline()
        output = servermanager.Fetch(quality)
        skewness = output.GetCellData().GetArray("Skewness")
        for cell, expected in enumerate((0, 0, 0.5, 0.5)):
            self.assertAlmostEqual(skewness.GetTuple1(cell), expected, 12)
        self.assertEqual(output.GetFieldData().GetArray("CriterionCellsBeyond").GetTuple1(0), 2)
        self.assertEqual(output.GetCellData().GetScalars().GetName(), "ScaledJacobian")

    def test_number_of_threads_is_set_and_read_back(self):
        quality = ScaledJacobian(Input=source(hexes(0.5, False)))
        self.assertEqual(quality.NumberOfThreads, 0)
        quality.NumberOfThreads = 3
        quality.UpdatePipeline()
        self.assertEqual(quality.NumberOfThreads, 3)
        self.assertIn("NumberOfThreads: 3\n", str(quality.GetClientSideObject()))
        with self.assertRaises(Exception):
            quality.MinScaledJacobian = 1.0

    def test_arrives_colored_with_the_break_at_zero(self):
        quality = ScaledJacobian(Input=source(hexes(1.0, True)))
        view = CreateRenderView()
        self.addCleanup(Delete, view)
        display = Show(quality, view)
        Render(view)
        self.assertEqual(list(display.ColorArrayName), ["CELLS", "ScaledJacobian"])
        colors = GetColorTransferFunction("ScaledJacobian")
        table = colors.GetClientSideObject()
        self.assertEqual(list(table.GetRange()), [-1.0, 1.0])
        below, above, best = [0] * 3, [0] * 3, [0] * 3
        table.GetColor(-0.01, below)
        table.GetColor(0.01, above)
        table.GetColor(1.0, best)
        # Magenta below; no blue in the poorest valid cells; blue in the best.
        self.assertGreater(min(below[0], below[2]), 0.9)
        self.assertLess(above[2], 0.3)
        self.assertGreater(best[2] - best[0], 0.4)

    def test_no_rescaling_moves_the_break(self):
        quality = ScaledJacobian(Input=source(hexes(1.0, False)))
        view = CreateRenderView()
        self.addCleanup(Delete, view)
        display = Show(quality, view)
        array = ("CELLS", "ScaledJacobian")
        colors = GetColorTransferFunction("ScaledJacobian")
        points = list(colors.RGBPoints)
        self.assertEqual(points[::4], [-1, -1e-12, 0, 0.2, 0.4, 0.6, 0.8, 1])
        for name, rescale in (
                ("ColorBy", lambda: ColorBy(display, array)),
                ("data", lambda: display.RescaleTransferFunctionToDataRange(False, True)),
                ("extended", lambda: display.RescaleTransferFunctionToDataRange(True, True)),
                ("time", display.RescaleTransferFunctionToDataRangeOverTime),
                ("visible", lambda: display.RescaleTransferFunctionToVisibleRange(view)),
                ("all data", lambda: colors.RescaleTransferFunctionToDataRange(False)),
                ("tiny", lambda: colors.RescaleTransferFunction(0.7071, 0.70711))):
            rescale()
            Render(view)
            self.assertEqual(list(colors.RGBPoints), points, name)
            self.assertEqual(list(colors.GetClientSideObject().GetRange()), [-1, 1], name)

        # A map of the display's own.
        ColorBy(display, array, True)
        self.assertNotEqual(display.LookupTable, colors)
        own = list(display.LookupTable.RGBPoints)
        self.assertTrue(own[4:8] != points[4:8] or own == points)
        ColorBy(display, array)

        # A state keeps the range, and one of an earlier version, written as Python, gets it.
        with tempfile.TemporaryDirectory() as folder:
            state = os.path.join(folder, "state.pvsm")
            SaveState(state)
            LoadState(state)
        table = display.LookupTable
        self.assertEqual(list(table.RGBPoints), points)
        table.RGBPoints = [x if i % 4 else 0.3 + 0.1 * x for i, x in enumerate(points)]
        self.assertEqual(list(table.RGBPoints), points)

    def test_a_user_may_unlock_the_range(self):
        colors = GetColorTransferFunction("ScaledJacobian")
        points = list(colors.RGBPoints)
        self.addCleanup(setattr, colors, "AutomaticRescaleRangeMode", "Never")
        self.addCleanup(setattr, colors, "RGBPoints", points)  # goes first, while it is unlocked
        colors.ApplyPreset("Viridis (matplotlib)", True)
        self.assertEqual((colors.RGBPoints[0], colors.RGBPoints[-4]), (-1, 1))
        colors.AutomaticRescaleRangeMode = "Clamp and update every timestep"
        colors.RescaleTransferFunction(0.25, 0.75)
        self.assertEqual((colors.RGBPoints[0], colors.RGBPoints[-4]), (0.25, 0.75))
        colors.AutomaticRescaleRangeMode = "Never"
        colors.RescaleTransferFunction(0, 1)
        self.assertEqual((colors.RGBPoints[0], colors.RGBPoints[-4]), (0.25, 0.75))
        colors.AutomaticRescaleRangeMode = "Clamp and update every timestep"

    def test_a_users_own_colors_for_other_arrays_are_left_alone(self):
        table = GetColorTransferFunction("SomethingElse")
        self.assertNotEqual(table.AutomaticRescaleRangeMode, "Never")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
