# SPDX-License-Identifier: BSD-3-Clause
"""The ways from a mesh to a morphed mesh, as a user walks them in the window.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> pvpython morph_routes.py
"""
import os
import unittest

import numpy as np
from paraview import servermanager, simple
from paraview.simple import (AppendDatasets, Calculator, ExtractSurface, GroupDatasets,
                             LoadPlugin, Tetrahedralize, Threshold, Transform, WarpByVector,
                             Wavelet)
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow

from versions import number_points

LoadPlugin(os.environ["MESHMORPHING_PLUGIN"], remote=False, ns=globals())

CELLS = 8


def hexes():
    """CELLS x CELLS x CELLS voxels with float points."""
    return AppendDatasets(Input=[Wavelet(WholeExtent=[0, CELLS, 0, CELLS, 0, CELLS])])


def points(proxy):
    proxy.UpdatePipeline()
    data = servermanager.Fetch(proxy).GetPoints()
    return vtk_to_numpy(data.GetData()).astype(float) if data else np.empty((0, 3))


def array(proxy, name):
    return vtk_to_numpy(servermanager.Fetch(proxy).GetPointData().GetArray(name))


def updated(proxy):
    """What the panel shows after Apply."""
    proxy.UpdatePipeline()
    proxy.UpdatePropertyInformation()
    return proxy


def rotation(degrees):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


class Messages:
    """Collects what would be printed."""

    def __enter__(self):
        self.window, self.before = vtkStringOutputWindow(), vtkOutputWindow.GetInstance()
        vtkOutputWindow.SetInstance(self.window)
        return self

    def __exit__(self, *_):
        vtkOutputWindow.SetInstance(self.before)
        self.text = self.window.GetOutput()


class Routes(unittest.TestCase):
    def setUp(self):
        self.grid = hexes()
        self.rest = points(self.grid)
        self.size = np.linalg.norm(np.ptp(self.rest, axis=0))

    def assertMoved(self, morph, expected):
        np.testing.assert_allclose(points(morph), expected, atol=2e-6 * self.size)
        updated(morph)
        self.assertEqual(morph.InvertedCells, 0)

    def test_extract_transform_morph(self):
        boundary = ExtractMorphBoundary(Input=self.grid)
        moved = Transform(Input=boundary)
        moved.Transform.Rotate = [0, 0, 30]
        moved.Transform.Scale = [1, 2, 1]
        moved.Transform.Translate = [3, 0, 0]
        # The default; it turns every array of three components.
        self.assertEqual(moved.TransformAllInputVectors, 1)
        morph = MorphFEMWARP(Input=self.grid, Boundary=moved)
        expected = (self.rest * [1, 2, 1]) @ rotation(30).T + [3, 0, 0]
        self.assertMoved(morph, expected)
        self.assertEqual(morph.PrepareCount, 1)
        self.assertEqual(morph.PrescribedPoints, (CELLS + 1) ** 3 - (CELLS - 1) ** 3)
        self.assertEqual(list(morph.CellData.keys()), ["ScaledJacobian"])
        np.testing.assert_allclose(array(morph, "MorphDisplacement"), expected - self.rest,
                                   atol=2e-6 * self.size)

    def test_every_method_goes_this_way(self):
        boundary = ExtractMorphBoundary(Input=self.grid)
        moved = Transform(Input=boundary)
        moved.Transform.Rotate = [0, 0, 30]
        moved.Transform.Scale = [1, 2, 1]
        bent = Calculator(Input=boundary, CoordinateResults=1,
                          Function="coords + 0.02*RestPosition_Z*RestPosition_Z*iHat")
        expected = (self.rest * [1, 2, 1]) @ rotation(30).T
        low, high = self.rest.min(axis=0), self.rest.max(axis=0)
        outer = ((self.rest == low) | (self.rest == high)).any(axis=1)
        for method in (MorphFEMWARP, MorphLBWARP, MorphSimplexLinear, MorphSimplexNaturalNeighbor,
                       MorphRadialBasis, MorphWeightedResidual):
            with self.subTest(method=method.__name__):
                morph = method(Input=self.grid, Boundary=moved)
                self.assertMoved(morph, expected)
                morph.Boundary = bent
                target = self.rest.copy()
                target[:, 0] += 0.02 * self.rest[:, 2] ** 2
                found = points(morph)
                np.testing.assert_allclose(found[outer], target[outer], atol=1e-5)
                # Inside each method has its own answer, near that of the others.
                self.assertLess(np.abs(found - target).max(), 0.5)
                self.assertEqual(updated(morph).PrepareCount, 1)

    def test_what_the_methods_count_is_in_the_panel(self):
        moved = Transform(Input=ExtractMorphBoundary(Input=self.grid))
        moved.Transform.Translate = [1, 0, 0]
        linear = updated(MorphSimplexLinear(Input=self.grid, Boundary=moved))
        for name in ("FoldedTetrahedra", "ExtrapolatedNodes"):
            self.assertEqual(getattr(linear, name), 0, name)
        natural = updated(MorphSimplexNaturalNeighbor(Input=self.grid, Boundary=moved))
        self.assertEqual(natural.WeightsStored, 1)
        with Messages() as messages:
            natural.MemoryLimit = 1e-4
            updated(natural)
        self.assertEqual(messages.text.count("memory limit"), 1, messages.text)
        self.assertEqual(natural.WeightsStored, 0)

    def test_dragging_prepares_once(self):
        moved = Transform(Input=ExtractMorphBoundary(Input=self.grid))
        morph = MorphFEMWARP(Input=self.grid, Boundary=moved)
        for step in range(4):
            moved.Transform.Rotate = [0, 0, 10 * step]
            self.assertMoved(morph, self.rest @ rotation(10 * step).T)
        self.assertEqual(morph.PrepareCount, 1)
        self.assertEqual(morph.PrepareSeconds, 0)
        self.assertGreater(morph.EvaluateSeconds, 0)

    def test_calculator_on_coordinates_and_rest_position(self):
        boundary = ExtractMorphBoundary(Input=self.grid)
        moved = Calculator(Input=boundary, CoordinateResults=1,
                           Function="coords + 0.25*RestPosition_Z*iHat")
        morph = MorphFEMWARP(Input=self.grid, Boundary=moved)
        expected = self.rest.copy()
        expected[:, 0] += 0.25 * self.rest[:, 2]
        self.assertMoved(morph, expected)

    def test_calculator_vector_as_displacement_array(self):
        boundary = ExtractMorphBoundary(Input=self.grid)
        shift = Calculator(Input=boundary, Function="0.5*coordsX*jHat", ResultArrayName="Shift")
        shift.UpdatePipeline()
        morph = MorphFEMWARP(Input=self.grid, Boundary=shift)
        self.assertEqual(morph.DisplacementArray, "None")
        self.assertIn("Shift", morph.GetProperty("DisplacementArray").GetAvailable())
        self.assertMoved(morph, self.rest)
        morph.DisplacementArray = "Shift"
        expected = self.rest.copy()
        expected[:, 1] += 0.5 * self.rest[:, 0]
        self.assertMoved(morph, expected)
        morph.ScaleFactor = 0
        self.assertMoved(morph, self.rest)

    def test_warp_by_vector(self):
        boundary = ExtractMorphBoundary(Input=self.grid)
        shift = Calculator(Input=boundary, Function="0.5*coordsX*jHat", ResultArrayName="Shift")
        shift.UpdatePipeline()
        warp = WarpByVector(Input=shift, Vectors=["POINTS", "Shift"], ScaleFactor=0.5)
        expected = self.rest.copy()
        expected[:, 1] += 0.25 * self.rest[:, 0]
        self.assertMoved(MorphFEMWARP(Input=self.grid, Boundary=warp), expected)

    def test_generate_ids_then_extract_surface(self):
        numbered = number_points(Input=self.grid)
        numbered.UpdatePipeline()
        moved = Transform(Input=ExtractSurface(Input=numbered))
        moved.Transform.Rotate = [0, 0, 20]
        morph = MorphFEMWARP(Input=self.grid, Boundary=moved)
        self.assertMoved(morph, self.rest @ rotation(20).T)

    def test_warped_copy_of_the_mesh(self):
        warped = Transform(Input=self.grid)
        warped.Transform.Scale = [1, 1, 3]
        self.assertMoved(MorphFEMWARP(Input=self.grid, Boundary=warped), self.rest * [1, 1, 3])

    def test_part_of_the_boundary(self):
        """The nodes that are not named stay."""
        boundary = ExtractMorphBoundary(Input=self.grid)
        z = self.rest[:, 2].max()
        scalar = Calculator(Input=boundary, Function="RestPosition_Z", ResultArrayName="Height")
        top = simple.Threshold(Input=scalar, Scalars=["POINTS", "Height"],
                               LowerThreshold=z - 1e-3, UpperThreshold=z + 1e-3)
        lifted = Transform(Input=top)
        lifted.Transform.Translate = [0, 0, 1]
        morph = MorphFEMWARP(Input=self.grid, Boundary=lifted)
        moved = points(morph)
        self.assertEqual(servermanager.Fetch(top).GetNumberOfPoints(), (CELLS + 1) ** 2)
        is_top = self.rest[:, 2] == z
        np.testing.assert_allclose(moved[is_top], self.rest[is_top] + [0, 0, 1], atol=1e-5)
        bottom = self.rest[:, 2] == self.rest[:, 2].min()
        self.assertTrue(np.array_equal(moved[bottom], self.rest[bottom]))
        inside = moved[:, 2] - self.rest[:, 2]
        self.assertGreater(inside[~is_top].max(), 0.1)
        self.assertLess(inside.max(), 1 + 1e-5)

    def test_tetrahedra(self):
        tets = Tetrahedralize(Input=self.grid)
        rest = points(tets)
        moved = Transform(Input=ExtractMorphBoundary(Input=tets))
        moved.Transform.Scale = [2, 1, 1]
        np.testing.assert_allclose(points(MorphFEMWARP(Input=tets, Boundary=moved)),
                                   rest * [2, 1, 1], atol=2e-6 * self.size)

    def test_blocks_come_out_as_blocks(self):
        ids = number_points(Input=self.grid, PointIdsArrayName="Node", CellIdsArrayName="Cell")
        half = CELLS ** 3 // 2
        parts = [Threshold(Input=ids, Scalars=["CELLS", "Cell"], LowerThreshold=first,
                           UpperThreshold=first + half - 1) for first in (0, half)]
        blocks = GroupDatasets(Input=parts)
        moved = Transform(Input=ExtractMorphBoundary(Input=blocks))
        moved.Transform.Rotate = [0, 0, 30]
        morph = updated(MorphFEMWARP(Input=blocks, Boundary=moved))
        self.assertEqual(morph.InvertedCells, 0)
        self.assertEqual(morph.MorphStatus, "Valid")
        self.assertEqual(morph.GetDataInformation().GetCompositeDataClassName(),
                         blocks.GetDataInformation().GetCompositeDataClassName())
        expected = self.rest @ rotation(30).T
        item = servermanager.Fetch(morph).NewIterator()
        item.InitTraversal()
        for part in parts:
            grid = item.GetCurrentDataObject()
            moved = vtk_to_numpy(grid.GetPoints().GetData()).astype(float)
            node = vtk_to_numpy(grid.GetPointData().GetArray("Node")).astype(int)
            self.assertEqual(len(moved), len(points(part)))
            np.testing.assert_allclose(moved, expected[node], atol=2e-6 * self.size)
            item.GoToNextItem()
        self.assertTrue(item.IsDoneWithTraversal())

    def test_surface_without_ids_is_one_error(self):
        moved = Transform(Input=ExtractSurface(Input=self.grid))
        with Messages() as messages:
            morph = MorphFEMWARP(Input=self.grid, Boundary=moved)
            morph.UpdatePipeline()
        self.assertEqual(messages.text.count("Extract Morph Boundary"), 1, messages.text)
        np.testing.assert_array_equal(points(morph), self.rest)

    def test_colored_by_quality(self):
        moved = Transform(Input=ExtractMorphBoundary(Input=self.grid))
        morph = MorphFEMWARP(Input=self.grid, Boundary=moved)
        morph.UpdatePipeline()
        view = simple.CreateRenderView()
        self.addCleanup(simple.Delete, view)
        display = simple.Show(morph, view)
        self.assertEqual(list(display.ColorArrayName), ["CELLS", "ScaledJacobian"])

    def test_scale_factor_animates(self):
        moved = Transform(Input=ExtractMorphBoundary(Input=self.grid))
        moved.Transform.Translate = [0, 0, 2]
        morph = MorphFEMWARP(Input=self.grid, Boundary=moved)
        scene = simple.GetAnimationScene()
        scene.PlayMode, scene.NumberOfFrames = "Sequence", 5
        scene.StartTime, scene.EndTime = 0, 1
        track = simple.GetAnimationTrack("ScaleFactor", proxy=morph)
        track.KeyFrames = [simple.CompositeKeyFrame(KeyTime=0, KeyValues=[0]),
                           simple.CompositeKeyFrame(KeyTime=1, KeyValues=[1])]
        for time in (0, 0.25, 1):
            scene.AnimationTime = time
            self.assertAlmostEqual(morph.ScaleFactor, time)
            self.assertMoved(morph, self.rest + [0, 0, 2 * time])
        self.assertEqual(morph.PrepareCount, 1)


if __name__ == "__main__":
    unittest.main()
