# SPDX-License-Identifier: BSD-3-Clause
"""Morph Shapes through the plugin: weights by script and by animation, names, rotations, and the
state of a session with several shapes.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> pvpython morph_shapes.py
"""
import os
import tempfile
import unittest
from pathlib import Path

import numpy
from paraview import servermanager, simple
from vtkmodules.numpy_interface.dataset_adapter import WrapDataObject

simple.LoadPlugin(os.environ["MESHMORPHING_PLUGIN"], remote=False, ns=globals())


def fetched(proxy):
    proxy.UpdatePipeline()
    return WrapDataObject(servermanager.Fetch(proxy))


def points(proxy):
    return numpy.array(fetched(proxy).Points)


def bar():
    """A bar from x = 0 to 8, made of hexahedra, and its boundary."""
    part = simple.AppendDatasets(Input=[simple.Wavelet(WholeExtent=[0, 8, 0, 3, 0, 3])])
    part.UpdatePipeline()
    return part


def shape(part, function):
    return simple.Calculator(Input=ExtractMorphBoundary(Input=part), Function=function,
                             CoordinateResults=1)


class MorphShapesTest(unittest.TestCase):
    def setUp(self):
        simple.ResetSession()
        self.part = bar()
        self.bend = shape(self.part, "coords + 0.02*coordsX*coordsX*jHat")
        self.stretch = shape(self.part, "coords + 0.25*coordsX*iHat")

    def blended(self, **options):
        return MorphShapes(registrationName="blend", Input=self.part,
                           Shapes=[self.bend, self.stretch], **options)

    def test_weights_blend_and_solve_nothing(self):
        blend = self.blended(Weights=[0, 1])
        rest = numpy.array(fetched(self.part).Points)
        numpy.testing.assert_allclose(points(blend), rest * [1.25, 1, 1], atol=1e-5)
        blend.Weights = [0, -0.5]
        numpy.testing.assert_allclose(points(blend), rest * [0.875, 1, 1], atol=1e-5)
        blend.Weights = [1, 0.5]
        both = points(blend)
        morph = MorphFEMWARP(Input=self.part, Boundary=shape(
            self.part, "coords + 0.02*coordsX*coordsX*jHat + 0.125*coordsX*iHat"))
        numpy.testing.assert_allclose(both, points(morph), atol=1e-5)
        self.assertEqual((blend.PrepareCount, blend.SolveCount), (1, 2))
        blend.Shapes = [self.stretch]
        blend.Weights = [1]
        numpy.testing.assert_allclose(points(blend), rest * [1.25, 1, 1], atol=1e-5)
        self.assertEqual((blend.PrepareCount, blend.SolveCount), (1, 2))

    def test_names_and_weights_are_field_data(self):
        blend = self.blended(Weights=[0.5], ShapeNames=["bend", "stretch"])
        data = fetched(blend).VTKObject.GetFieldData()
        names = data.GetAbstractArray("ShapeNames")
        self.assertEqual([names.GetValue(i) for i in range(2)], ["bend", "stretch"])
        weights = data.GetArray("ShapeWeights")
        self.assertEqual([weights.GetValue(i) for i in range(2)], [0.5, 0])

    def test_weight_is_animated(self):
        blend = self.blended(Weights=[0, 0])
        scene = simple.GetAnimationScene()
        scene.PlayMode, scene.NumberOfFrames = "Sequence", 5
        scene.StartTime, scene.EndTime = 0, 1
        track = simple.GetAnimationTrack("Weights", index=1, proxy=blend)
        track.KeyFrames = [simple.CompositeKeyFrame(KeyTime=t, KeyValues=[t]) for t in (0, 1)]
        ends = []
        for time in (0, 0.25, 0.5, 0.75, 1):
            scene.AnimationTime = time
            ends.append(points(blend)[:, 0].max())
        numpy.testing.assert_allclose(ends, [8, 8.5, 9, 9.5, 10], atol=1e-5)

    def test_rotation_keeps_lengths(self):
        turned = BoundaryDisplacement(Input=self.part, Moving="Region",
                                      Surroundings="Stay")
        turned.Region = "Plane"
        turned.Region.Origin, turned.Region.Normal = [7.5, 0, 0], [-1, 0, 0]
        turned.Transform.Rotate = [90, 0, 0]
        blend = MorphShapes(Input=self.part, Shapes=[turned], Weights=[0.5],
                            Motions=["As rotation"])
        rest = numpy.array(fetched(self.part).Points)
        end = rest[:, 0] == 8
        half = numpy.sqrt(0.5)
        expected = rest[end] @ numpy.array([[1, 0, 0], [0, half, half], [0, -half, half]])
        numpy.testing.assert_allclose(points(blend)[end], expected, atol=1e-5)
        self.assertEqual(blend.SolveCount, 2)
        blend.Motions = ["As displacement"]
        lost = numpy.linalg.norm(points(blend)[end][:, 1:], axis=1)
        numpy.testing.assert_allclose(lost, half * numpy.linalg.norm(rest[end][:, 1:], axis=1),
                                      atol=1e-5)

    def test_table_of_designs_is_a_series(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "doe.csv")
            path.write_text("note,bend,stretch\n1,0,0\n2,0,0.5\n3,0,-4.5\n", encoding="utf-8")
            table = simple.CSVReader(FileName=[str(path)])
            blend = self.blended(ShapeNames=["bend", "stretch"], Table=table)
            blend.UpdatePipelineInformation()
            self.assertEqual(list(blend.TimestepValues), [0, 1, 2])
            ends = []
            for time in blend.TimestepValues:
                blend.UpdatePipeline(time)
                ends.append(blend.GetDataInformation().GetBounds()[1])
            numpy.testing.assert_allclose(ends[:2], [8, 9], atol=1e-5)
            self.assertEqual(blend.InvertingDesigns, "2")
            series = str(Path(folder, "designs.vtu"))
            simple.SaveData(series, proxy=blend, Writetimestepsasfileseries=1)
            self.assertEqual(len(list(Path(folder).glob("designs_*.vtu"))), 3)
            over_time = simple.PlotDataOverTime(Input=blend, FieldAssociation="Cells")
            self.assertEqual(fetched(over_time).VTKObject.GetBlock(0).GetNumberOfRows(), 3)

    def test_state(self):
        blend = self.blended(Weights=[0.25, 0.75], ShapeNames=["bend", "stretch"],
                             Motions=["As displacement", "As displacement"], Method="LBWARP")
        before = points(blend)
        with tempfile.TemporaryDirectory() as folder:
            path = str(Path(folder, "state.pvsm"))
            simple.SaveState(path)
            simple.ResetSession()
            simple.LoadState(path)
        blend = simple.FindSource("blend")
        self.assertEqual(list(blend.Weights), [0.25, 0.75])
        self.assertEqual(list(blend.ShapeNames), ["bend", "stretch"])
        numpy.testing.assert_array_equal(points(blend), before)


if __name__ == "__main__":
    unittest.main()
