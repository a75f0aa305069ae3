# SPDX-License-Identifier: BSD-3-Clause
"""The Python module as it is installed: the example of HowTo/MorphFromNumPy.md, numpy there and
back, docstrings, and what the module refuses.

Run: PYTHONPATH=<prefix>/lib/python3/dist-packages:<VTK's> MESHMORPHING_MODELS=<small models>
         python3 installed_python.py
"""
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import meshmorphing.vtk as mm
import numpy
from vtkmodules.numpy_interface import dataset_adapter
from vtkmodules.util import numpy_support
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader, vtkXMLUnstructuredGridWriter

ROOT = Path(__file__).resolve().parents[2]

MODEL = os.path.join(os.environ["MESHMORPHING_MODELS"], "bore_hex_small.vtu")
METHODS = [mm.vtkFEMWarpMorph, mm.vtkLBWarpMorph, mm.vtkSimplexLinearMorph,
           mm.vtkSimplexNaturalNeighborMorph, mm.vtkRadialBasisMorph, mm.vtkWeightedResidualMorph]


def read():
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(MODEL)
    reader.Update()
    return dataset_adapter.WrapDataObject(reader.GetOutput())


def boundary_of(grid):
    extract = mm.vtkExtractMorphBoundary()
    extract.SetInputData(grid.VTKObject)
    extract.Update()
    return dataset_adapter.WrapDataObject(extract.GetOutput())


class InstalledPython(unittest.TestCase):
    def test_documented_example(self):
        page = (ROOT / "Documentation/HowTo/MorphFromNumPy.md").read_text(encoding="utf-8")
        blocks = re.findall(r"^```py\n(.*?)^```", page, re.MULTILINE | re.DOTALL)
        self.assertEqual(len(blocks), 1)
        lines = [line for line in blocks[0].splitlines()
                 if line and not line.startswith(("import", "from"))]
        self.assertEqual(len(lines), 14)
        with tempfile.TemporaryDirectory() as folder:
            writer = vtkXMLUnstructuredGridWriter()
            writer.SetFileName(os.path.join(folder, "bore_hex_small.vtu"))
            writer.SetInputData(read().VTKObject)
            self.assertEqual(writer.Write(), 1)
            # VTK 9.3's own modules use what NumPy 2 deprecates.
            result = subprocess.run(
                [sys.executable, "-W", "ignore::DeprecationWarning", "-c", blocks[0]], cwd=folder,
                capture_output=True, text=True, timeout=60)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        said = re.search(r"^The output is `(.*)\.\.\. 0`\.", page, re.MULTILINE)[1]
        self.assertRegex(result.stdout, rf"^{re.escape(said)}\d* 0\n$")

    def test_every_result_has_a_getter(self):
        section, getters = None, 0
        table = ROOT / "Filters/Morphing/Results.txt"
        for line in table.read_text(encoding="utf-8").splitlines():
            if line.startswith("["):
                section = line.strip("[]")
            elif line and not line.startswith("#") and line.split()[1] != "counts":
                owner = "vtkFEMWarpMorph" if section == "vtkMorphAlgorithm" else section
                name, kind = line.split()[:2]
                value = getattr(getattr(mm, owner)(), "Get" + name)()
                self.assertIsInstance(value, {"double": float, "text": str}.get(kind, int), name)
                getters += 1
        self.assertGreater(getters, 50)

    def test_numpy_there_and_back(self):
        grid = read()
        shear = numpy.array([[1, 0.2, 0], [0, 1.1, 0], [0.1, 0, 1]])
        boundary = boundary_of(grid)
        ids = boundary.PointData["MorphPointId"]
        self.assertTrue(numpy.array_equal(boundary.Points, grid.Points[ids]))
        boundary.Points = boundary.Points @ shear
        for method in METHODS:
            with self.subTest(method=method.__name__):
                morph = method()
                morph.SetInputData(grid.VTKObject)
                morph.SetBoundaryData(boundary.VTKObject)
                morph.Update()
                moved = dataset_adapter.WrapDataObject(morph.GetOutput())
                self.assertTrue(numpy.array_equal(moved.Points[ids], boundary.Points))
                self.assertLess(abs(moved.Points - grid.Points @ shear).max(), 1e-5)
                self.assertEqual(moved.CellData["ScaledJacobian"].min(),
                                 morph.GetMinScaledJacobian())

    def test_adjoint_from_numpy(self):
        grid, boundary = read(), boundary_of(read())
        gradient = numpy.random.default_rng(7).normal(size=grid.Points.shape)
        morph = mm.vtkFEMWarpMorph()
        result = numpy_support.numpy_to_vtk(numpy.empty((0, 3)))
        self.assertTrue(morph.ApplyTranspose(grid.VTKObject, boundary.VTKObject,
                                             numpy_support.numpy_to_vtk(gradient), result))
        result = numpy_support.vtk_to_numpy(result)
        self.assertEqual(result.shape, boundary.Points.shape)
        # A shift of the boundary shifts everything.
        self.assertLess(abs(result.sum(axis=0) - gradient.sum(axis=0)).max(), 1e-7)

    def test_docstrings(self):
        for method in METHODS + [mm.vtkInversionFreeMorph]:
            self.assertRegex(method.__doc__, "Superclass: vtkMorphAlgorithm")
            self.assertTrue(issubclass(method, mm.vtkMorphAlgorithm))
        self.assertIn("Default 1e-10", mm.vtkFEMWarpMorph.SetTolerance.__doc__)
        self.assertIn("adjoint", mm.vtkMorphAlgorithm.ApplyTranspose.__doc__)
        self.assertIn("paraview.simple", mm.__doc__)

    def test_errors_are_vtk_errors(self):
        morph = mm.vtkFEMWarpMorph()
        messages = []
        observer = lambda _, __, text: messages.append(text)  # noqa: E731
        observer.CallDataType = "string0"
        morph.AddObserver("ErrorEvent", observer)
        morph.SetInputData(read().VTKObject)
        morph.Update()
        self.assertEqual(len(messages), 1)
        self.assertIn("Boundary: nothing is connected", messages[0])
        self.assertEqual((morph.GetMorphStatus(), morph.GetInvertedCells()), ("Failed", -1))

    def test_it_is_refused_beside_paraview(self):
        code = ("import sys, types; sys.modules['paraview'] = types.ModuleType('paraview'); "
                "import meshmorphing.vtk")
        result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True,
                                timeout=60)
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("paraview.simple", result.stderr)

    def test_another_vtk_is_refused(self):
        code = ("from vtkmodules import vtkCommonCore; "
                "vtkCommonCore.vtkVersion = "
                "type('Other', (), {'GetVTKVersion': staticmethod(lambda: '8.2.0')}); "
                "import meshmorphing.vtk")
        result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True,
                                timeout=60)
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("found VTK 8.2.0", result.stderr)


if __name__ == "__main__":
    unittest.main()
