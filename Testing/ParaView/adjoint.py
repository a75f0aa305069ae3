# SPDX-License-Identifier: BSD-3-Clause
"""Morph Adjoint through the plugin: the worked example converges, and its gradient is that of
finite differences.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> pvpython adjoint.py
"""
import os
import re
import shutil
import subprocess
import unittest
from pathlib import Path

import numpy
from paraview import servermanager, simple
from vtkmodules.numpy_interface.dataset_adapter import WrapDataObject

PLUGIN = os.environ["MESHMORPHING_PLUGIN"]
SOURCE = Path(__file__).resolve().parents[2]
simple.LoadPlugin(PLUGIN, remote=False, ns=globals())


class Adjoint(unittest.TestCase):
    def test_example_fits_the_bore(self):
        model = SOURCE / "Data" / "Models" / "small" / "bore_hex_small.vtu"
        program = [shutil.which("pvpython"), str(SOURCE / "Examples" / "fit_bore.py")]
        result = subprocess.run([*program, PLUGIN, str(model)],
                                capture_output=True, text=True, timeout=250)
        self.assertEqual((result.returncode, result.stderr), (0, ""), result.stdout)
        self.assertLess(float(re.search(r"relative error (\S+)", result.stdout).group(1)), 1e-7)
        found = re.findall(r"objective (\S+), largest distance to the target boundary (\S+)",
                           result.stdout)
        objectives, errors = numpy.array(found, dtype=float).T
        self.assertEqual(len(objectives), 21)
        self.assertTrue((numpy.diff(objectives) < 0).all(), objectives)
        self.assertLess(objectives[-1], 1e-8 * objectives[0])
        self.assertLess(errors[-1], 1e-3 * errors[0])

    def test_example_fits_shapes(self):
        model = SOURCE / "Data" / "Models" / "small" / "bore_hex_small.vtu"
        program = [shutil.which("pvpython"), str(SOURCE / "Examples" / "fit_shapes.py")]
        result = subprocess.run([*program, PLUGIN, str(model)],
                                capture_output=True, text=True, timeout=250)
        self.assertEqual((result.returncode, result.stderr), (0, ""), result.stdout)
        errors = re.findall(r"relative error (\S+)", result.stdout)
        self.assertEqual(len(errors), 3)
        self.assertLess(max(map(float, errors)), 1e-5)
        iterations, objective = re.search(r"after (\d+) iterations: objective (\S+),",
                                          result.stdout).groups()
        self.assertLessEqual(int(iterations), 15)
        self.assertLess(float(objective), 1e-10)
        self.assertLess(float(re.search(r"largest error (\S+)", result.stdout).group(1)), 1e-2)
        self.assertIn("displacement fields solved: 3; mesh Valid", result.stdout)

    def test_method_behind_the_gradient_is_taken(self):
        part = simple.AppendDatasets(Input=[simple.Wavelet(WholeExtent=[0, 4, 0, 4, 0, 4])])
        boundary = ExtractMorphBoundary(Input=part)
        moved = simple.Calculator(Input=boundary, Function="coords + 0.1*coordsX*jHat",
                                  CoordinateResults=1)
        morph = MorphWeightedResidual(Input=part, Boundary=moved)
        # The objective x^2/2 + 3 y summed over the nodes.
        objective = simple.Calculator(Input=morph, Function="coordsX*iHat + 3*jHat",
                                      ResultArrayName="dJdx")
        adjoint = MorphAdjoint(Input=part, Boundary=moved, Gradient=objective, GradientArray="dJdx")
        adjoint.UpdatePipeline()
        result = WrapDataObject(servermanager.Fetch(adjoint))
        gradient = numpy.array(result.PointData["MorphGradient"])
        self.assertEqual(result.VTKObject.GetClassName(), "vtkPolyData")
        # A shift of the boundary shifts every node: 125 nodes, x from 0 to 4.
        numpy.testing.assert_allclose(gradient.sum(axis=0), [250, 375, 0], atol=1e-4)
        morph.UpdatePropertyInformation()
        self.assertEqual(morph.PrepareCount, 1)


if __name__ == "__main__":
    unittest.main()
