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


if __name__ == "__main__":
    unittest.main()
