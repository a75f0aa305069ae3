# SPDX-License-Identifier: BSD-3-Clause
"""A morph of several steps played by ParaView's animation, saved as pictures and as a series of
files, and plotted over time.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> pvpython time_steps.py
"""
import os
import tempfile
import unittest
from pathlib import Path

import numpy as np
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy

simple.LoadPlugin(os.environ["MESHMORPHING_PLUGIN"], remote=False, ns=globals())

STEPS = 4
CANISTER = Path(__file__).resolve().parents[2] / "Data/Models/small/canister_hex_small.vtu"


def table(proxy):
    """The table of a filter, as a numpy array for each column of numbers.

    ParaView's plots over time have their table in a block."""
    proxy.UpdatePipeline()
    data = servermanager.Fetch(proxy, idx=proxy.Port)
    data = data.GetBlock(0) if data.IsA("vtkMultiBlockDataSet") else data
    columns = [data.GetColumn(i) for i in range(data.GetNumberOfColumns())]
    return {column.GetName(): vtk_to_numpy(column) for column in columns if column.IsNumeric()}


def points(proxy):
    return vtk_to_numpy(servermanager.Fetch(proxy).GetPoints().GetData()).copy()


class TimeSteps(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.grid = simple.AppendDatasets(Input=[simple.Wavelet(WholeExtent=[0, 6] * 3)])
        surface = ExtractMorphBoundary(Input=cls.grid)
        cls.boundary = simple.Calculator(Input=surface, CoordinateResults=1,
                                         Function="coords + 3*sin(coordsX)*kHat")
        cls.morph = MorphFEMWARP(Input=cls.grid, Boundary=cls.boundary, NumberOfSteps=STEPS,
                                 Validity="None")
        cls.steps = []
        for step in range(STEPS + 1):
            cls.morph.UpdatePipeline(step)
            minimum, inverted = cls.morph.MinScaledJacobian, cls.morph.InvertedCells
            cls.steps.append((points(cls.morph), minimum, inverted))

    def test_play(self):
        """The panel's numbers and the bad cells follow the time."""
        view = simple.CreateRenderView(ViewSize=[200, 150])
        self.addCleanup(simple.Delete, view)
        bad = simple.OutputPort(self.morph, "Bad cells")
        simple.Show(self.morph, view)
        simple.Show(bad, view)
        scene = simple.GetAnimationScene()
        scene.UpdateAnimationUsingDataTimeSteps()
        self.assertEqual(list(scene.TimeKeeper.TimestepValues), list(range(STEPS + 1)))
        self.assertGreater(self.steps[-1][2], 0)
        for time in (0, 1, 2, 3, 4, 0, 3):
            scene.AnimationTime = time
            _, minimum, inverted = self.steps[time]
            self.assertEqual((self.morph.MinScaledJacobian, self.morph.InvertedCells),
                             (minimum, inverted))
            self.assertEqual(bad.GetDataInformation().GetNumberOfCells(), inverted)
        with tempfile.TemporaryDirectory() as folder:
            simple.SaveAnimation(str(Path(folder, "morph.png")), view, ImageResolution=[200, 150])
            frames = sorted(Path(folder).glob("*.png"))
            self.assertEqual(len(frames), STEPS + 1)
            self.assertEqual(len({frame.read_bytes() for frame in frames}), STEPS + 1)

    def test_series_of_files(self):
        with tempfile.TemporaryDirectory() as folder:
            file = str(Path(folder, "morph.pvd"))
            # Debian's expat cannot read the appended data of the default.
            simple.SaveData(file, proxy=self.morph, WriteTimeSteps=1, DataMode="Ascii")
            read = simple.PVDReader(FileName=file)
            self.assertEqual(list(read.TimestepValues), list(range(STEPS + 1)))
            for time, (expected, minimum, _) in enumerate(self.steps):
                read.UpdatePipeline(time)
                np.testing.assert_array_equal(points(read), expected)
                data = servermanager.Fetch(read)
                array = data.GetFieldData().GetArray("MinScaledJacobian")
                self.assertEqual(array.GetValue(0), minimum)

    def test_plots_over_time(self):
        minima = [minimum for _, minimum, _ in self.steps]
        whole = table(simple.PlotGlobalVariablesOverTime(Input=self.morph))
        np.testing.assert_array_equal(whole["Time"], range(STEPS + 1))
        np.testing.assert_array_equal(whole["MinScaledJacobian"], minima)
        np.testing.assert_array_equal(whole["InvertedCells"],
                                      [inverted for *_, inverted in self.steps])
        cells = table(simple.PlotDataOverTime(Input=self.morph, FieldAssociation="Cells"))
        np.testing.assert_array_equal(cells["min(ScaledJacobian)"], minima)

    def test_chart_of_methods(self):
        compare = CompareMorphMethods(Input=self.grid, Boundary=self.boundary, NumberOfSteps=STEPS,
                                      Relative=0, Smoothing=0, InversionFree=0)
        chart = simple.OutputPort(compare, "Minimum Scaled Jacobian")
        minima = table(chart)
        np.testing.assert_array_equal(minima["Time"], range(STEPS + 1))
        np.testing.assert_array_equal(minima["FEMWARP, Absolute"],
                                      [minimum for _, minimum, _ in self.steps])
        view = simple.CreateView("XYChartView")
        self.addCleanup(simple.Delete, view)
        display = simple.Show(chart, view)
        self.assertEqual(display.XArrayName, "Time")
        # The chart shows every method, in the order of their names.
        self.assertEqual(list(display.SeriesVisibility),
                         sorted(name for name in minima if name != "Time"))


class Turns(unittest.TestCase):
    """A step is the motion at a fraction of its numbers: a part that turns keeps its size."""

    @classmethod
    def setUpClass(cls):
        cls.mesh = simple.OpenDataFile(str(CANISTER))

    def half_way(self, **motion):
        """The distance of the mesh at half of the motion from that by `half` of its numbers."""
        half = MorphMesh(Input=self.mesh, Surfaces=["Surface 3"], Validity="None",
                         Displacement="Translate, rotate, scale", Translation=[0, 0, 0.25],
                         Rotation=[0, 0, 45], Scale=[1.5, 1, 1], Surroundings="Follow everywhere")
        stepped = MorphMesh(Input=self.mesh, Surfaces=["Surface 3"], Validity="None",
                            NumberOfSteps=2, Surroundings="Follow everywhere", **motion)
        half.UpdatePipeline()
        stepped.UpdatePipeline(1)
        self.assertGreater(np.abs(points(half) - points(self.mesh)).max(), 0.1)
        return np.abs(points(half) - points(stepped)).max()

    def test_numbers(self):
        by = {"Displacement": "Translate, rotate, scale", "Translation": [0, 0, 0.5],
              "Rotation": [0, 0, 90], "Scale": [2, 1, 1]}
        self.assertLess(self.half_way(**by), 1e-12)

    def test_an_angle(self):
        """Two sides of a box, at 90 degrees, are opened to 120."""
        box = simple.AppendDatasets(Input=[simple.Wavelet(WholeExtent=[0, 4] * 3)])
        half, whole = (MorphMesh(Input=box, Surfaces=["Surface 0", "Surface 2"], Validity="None",
                                 Displacement="Dimension", **more)
                       for more in ({"Dimension": 105}, {"Dimension": 120, "NumberOfSteps": 2}))
        half.UpdatePipeline()
        whole.UpdatePipeline(1)
        self.assertAlmostEqual(whole.PresentDimension, 90)
        self.assertGreater(np.abs(points(whole) - points(box)).max(), 0.1)
        self.assertLess(np.abs(points(half) - points(whole)).max(), 1e-12)

    def test_a_transform_about_any_point(self):
        """Its matrix alone is known, so the axis is found: here it is one far from the part."""
        whole, half = (BoundaryDisplacement(Input=self.mesh, Displacement="Transform", **more)
                       for more in ({"ScaleFactor": 0.5}, {}))
        for filter_, angle in ((whole, 90), (half, 45)):
            filter_.Transform = "RotateAroundOriginTransform"
            filter_.Transform.Rotate = [0, angle, 0]
            filter_.Transform.Originofrotation = [40, -20, 10]
            filter_.UpdatePipeline()
        self.assertGreater(np.abs(points(whole)).max(), 10)
        self.assertLess(np.abs(points(whole) - points(half)).max(), 1e-12)


if __name__ == "__main__":
    unittest.main()
