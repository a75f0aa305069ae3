# SPDX-License-Identifier: BSD-3-Clause
"""Validity and Morph Inversion Free through the plugin: defaults, what a user is told, what the
output is then, and state files.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> MESHMORPHING_XML=<its XML files, : between>
         pvpython validity.py
"""
import math
import os
import re
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "Data"), str(ROOT / "Utilities")]
import Models  # noqa: E402  (needs the path above)
from demo_picture import producer  # noqa: E402

PLUGIN = os.environ["MESHMORPHING_PLUGIN"]
simple.LoadPlugin(PLUGIN, remote=False, ns=globals())

CELLS = 6
# Steep waves along the cube: they turn FEMWARP's cells over.
WAVES = "coords + 2*sin(1.0471975511965976*RestPosition_X)*kHat"
# One corner goes through the cell behind it, all of whose neighbors there are prescribed.
CORNER_PUSHED_IN = ("coords + if(RestPosition_X + RestPosition_Y + RestPosition_Z < 0.5, 1.5, 0)"
                    "*(iHat + jHat + kHat)")
# The top goes below the bottom, and nothing else is prescribed.
TOP_PUSHED_DOWN = f"coords - if(RestPosition_Z > {CELLS - 0.5}, 7, 0)*kHat"


def hexes():
    return simple.AppendDatasets(Input=[simple.Wavelet(WholeExtent=[0, CELLS] * 3)])


def moved(grid, function):
    boundary = ExtractMorphBoundary(Input=grid)
    return simple.Calculator(Input=boundary, Function=function, CoordinateResults=1)


def points(proxy):
    data = servermanager.Fetch(proxy).GetPoints()
    return vtk_to_numpy(data.GetData()).astype(float) if data else np.empty((0, 3))


def status(proxy):
    """The field data MorphStatus; the property says the same."""
    value = servermanager.Fetch(proxy).GetFieldData().GetAbstractArray("MorphStatus").GetValue(0)
    assert proxy.MorphStatus == value, (proxy.MorphStatus, value)
    return value


def quality(proxy):
    """Scaled Jacobians as another filter measures the output."""
    measured = ScaledJacobian(Input=proxy)
    measured.UpdatePipeline()
    return vtk_to_numpy(servermanager.Fetch(measured).GetCellData().GetArray("ScaledJacobian"))


def updated(proxy):
    """What is printed when the user applies the filter."""
    window, before = vtkStringOutputWindow(), vtkOutputWindow.GetInstance()
    vtkOutputWindow.SetInstance(window)
    try:
        proxy.UpdatePipeline()
    finally:
        vtkOutputWindow.SetInstance(before)
    proxy.UpdatePropertyInformation()
    return window.GetOutput()


def methods():
    """The proxies that have Validity, by name in pvpython: the properties' XML elements."""
    found = {}
    for path in os.environ["MESHMORPHING_XML"].split(":"):
        for proxy in ElementTree.parse(path).getroot().findall("ProxyGroup[@name='filters']/*"):
            for p in proxy:
                if p.get("name") == "Validity":
                    found[proxy.get("label").replace(" ", "")] = p
    return found


class Validity(unittest.TestCase):
    def setUp(self):
        self.grid = hexes()
        self.grid.UpdatePipeline()
        self.rest = points(self.grid)
        self.outer = ((self.rest == 0) | (self.rest == CELLS)).any(axis=1)

    def morph(self, method, function, **properties):
        return globals()[method](Input=self.grid, Boundary=moved(self.grid, function), **properties)

    def target(self):
        result = self.rest.copy()
        result[:, 2] += 2 * np.sin(math.pi / 3 * self.rest[:, 0])
        return result

    def assertValid(self, morph):
        self.assertEqual(morph.InvertedCells, 0)
        self.assertGreater(quality(morph).min(), 0)
        self.assertAlmostEqual(quality(morph).min(), morph.MinScaledJacobian, delta=1e-12)

    def assertArrived(self, morph):
        self.assertEqual(morph.LargestValidStep, 1)
        np.testing.assert_allclose(points(morph)[self.outer], self.target()[self.outer], atol=1e-5)

    def test_default_of_each_method(self):
        found = methods()
        self.assertIn("MorphInversionFree", found)
        self.assertIn("MorphFEMWARP", found)
        for name in found:
            with self.subTest(method=name):
                expected = {"MorphInversionFree": "Sub step", "MorphMesh": "Repair",
                            "RepairMesh": "Repair all"}
                morph = globals()[name](Input=self.grid)
                self.assertEqual(morph.Validity, expected.get(name, "Report"))
                self.assertEqual(morph.GetProperty("Validity").GetAvailable(),
                                 ["None", "Report", "Sub step", "Repair", "Refuse",
                                  "Repair all"])

    def test_report_warns_of_the_worst_cells(self):
        morph = self.morph("MorphFEMWARP", WAVES)
        text = updated(morph)
        self.assertEqual(text.count("WARN") + text.count("Warning"), 1, text)
        self.assertIn(f"{morph.InvertedCells:.0f} cells are inverted", text)
        measured = quality(morph)
        self.assertEqual(np.count_nonzero(measured <= 0), morph.InvertedCells)
        named = re.findall(r"cell (\d+) at \(([^)]*)\), scaled Jacobian (\S+)", text)
        self.assertEqual(len(named), 10)
        worst = np.sort(measured)[:10]
        grid = servermanager.Fetch(morph)
        for (cell, center, value), expected in zip(named, worst):
            self.assertAlmostEqual(float(value), expected, delta=1e-5)
            self.assertAlmostEqual(measured[int(cell)], expected, delta=1e-5)  # float points
            corners = vtk_to_numpy(grid.GetCell(int(cell)).GetPoints().GetData())
            np.testing.assert_allclose([float(x) for x in center.split(",")],
                                       corners.mean(axis=0), atol=1e-4)
        self.assertEqual(status(morph), "Inverted")
        self.assertEqual(morph.LargestValidStep, -1)  # not known

        morph.Validity = "None"
        self.assertEqual(updated(morph), "")
        self.assertEqual(morph.InvertedCells, np.count_nonzero(measured <= 0))

    def test_sub_steps_and_repair_go_all_the_way(self):
        for validity, expected in (("Sub step", "SubStepped"), ("Repair", "Repaired")):
            with self.subTest(validity=validity):
                morph = self.morph("MorphFEMWARP", WAVES, Validity=validity)
                self.assertEqual(updated(morph), "")
                self.assertEqual(status(morph), expected)
                self.assertValid(morph)
                self.assertArrived(morph)
                self.assertEqual(morph.SubSteps > 1, validity == "Sub step")

    def test_inversion_free(self):
        morph = self.morph("MorphInversionFree", WAVES)
        self.assertEqual(updated(morph), "")
        self.assertEqual(status(morph), "Valid")
        self.assertValid(morph)
        self.assertArrived(morph)
        for name in ("NewtonSteps", "LinearIterations", "EnergyEvaluations"):
            self.assertGreater(morph.GetProperty(name).GetData(), 0, name)
        least = 0
        for effort in ("Quick", "Default", "Thorough"):
            with self.subTest(effort=effort):
                morph.Effort = effort
                self.assertEqual(updated(morph), "")
                self.assertValid(morph)
                self.assertArrived(morph)
                self.assertGreaterEqual(morph.MinScaledJacobian, 0.99 * least)
                least = morph.MinScaledJacobian

    def test_inversion_free_is_never_worse_than_simplex_linear(self):
        mesh = Models.get("bore").read_small("hex")
        rest, boundary = producer(mesh.to_vtk()), producer(mesh.boundary_to_vtk(1))
        free, linear = (method(Input=rest, Boundary=boundary)
                        for method in (MorphInversionFree, MorphSimplexLinear))
        updated(free)
        updated(linear)
        self.assertGreater(linear.MinScaledJacobian, 0.5)
        self.assertGreater(free.MinScaledJacobian, 1.05 * linear.MinScaledJacobian)

    def test_repair_mesh_untangles_and_the_boundary_stays(self):
        tangled = simple.Calculator(Input=hexes(), CoordinateResults=1, Function=(
            "coords + 2*sin(1.5*coordsX)*sin(0.5235987755982988*coordsX)"
            "*sin(0.5235987755982988*coordsY)*sin(0.5235987755982988*coordsZ)*(iHat + kHat)"))
        repaired = RepairMesh(Input=tangled)
        repaired.UpdatePipeline()
        self.assertEqual(status(repaired), "Repaired")
        self.assertGreater(repaired.InvertedBefore, 5)
        self.assertEqual(repaired.InvertedCells, 0)
        self.assertGreater(repaired.MinScaledJacobian, 0)
        before, after = points(tangled), points(repaired)
        rest = points(hexes())
        outside = ((rest < 1e-9) | (rest > CELLS - 1e-9)).any(axis=1)
        np.testing.assert_array_equal(after[outside], before[outside])
        again = RepairMesh(Input=repaired)  # nothing is left to do
        again.UpdatePipeline()
        np.testing.assert_array_equal(points(again), after)

    def test_partial_is_an_error_with_a_valid_output(self):
        for method in ("MorphFEMWARP", "MorphInversionFree"):
            with self.subTest(method=method):
                boundary = moved(self.grid, TOP_PUSHED_DOWN)
                plates = simple.Threshold(
                    Input=simple.Calculator(Input=boundary, ResultArrayName="Side",
                                            Function=f"abs(RestPosition_Z - {CELLS / 2})"),
                    Scalars=["POINTS", "Side"], LowerThreshold=CELLS / 2 - 0.5,
                    UpperThreshold=CELLS)
                morph = globals()[method](Input=self.grid, Boundary=plates, FixUnnamedBoundary=0,
                                          Validity="Sub step", MaximumSubSteps=8)
                text = updated(morph)
                self.assertEqual(text.count("No valid mesh was found for the whole motion"), 1,
                                 text)
                self.assertEqual(text.count("ERR"), 1, text)
                self.assertEqual(status(morph), "Partial")
                self.assertValid(morph)
                # The plates meet at 6/7 of the motion.
                self.assertLess(morph.LargestValidStep, 6 / 7)
                self.assertGreater(morph.LargestValidStep, 6 / 7 - 0.05)
                top = points(morph)[self.rest[:, 2] == CELLS]
                np.testing.assert_allclose(top[:, 2], CELLS - 7 * morph.LargestValidStep, atol=1e-5)

    def test_a_refusal_gives_the_undeformed_mesh(self):
        refused = self.morph("MorphFEMWARP", WAVES, Validity="Refuse")
        self.assertEqual(updated(refused).count("refused"), 1)
        impossible = self.morph("MorphInversionFree", CORNER_PUSHED_IN)
        text = updated(impossible)
        self.assertIn("The boundary itself inverts 1 cells", text)
        self.assertIn("cell ids 0.", text)
        self.assertEqual(impossible.PrepareCount, 0)
        for morph in (refused, impossible):
            np.testing.assert_array_equal(points(morph), self.rest)
            self.assertEqual(status(morph), "Failed")
            self.assertEqual((morph.InvertedCells, morph.MinScaledJacobian), (-1, -1))
            # What scripts ask for.
            self.assertNotEqual(morph.LargestValidStep, 1)

        impossible.Validity = "Report"
        self.assertIn("cell ids 0.", updated(impossible))
        self.assertEqual((impossible.BoundaryDeterminedCells, impossible.InvertedCells), (1, 1))
        self.assertEqual(impossible.WorstCellId, 0)

    def test_state_files_keep_the_properties(self):
        values = {"Validity": "Repair", "MaximumSubSteps": 7, "Effort": "Thorough"}
        with tempfile.TemporaryDirectory() as folder:
            for suffix in (".pvsm", ".py"):
                with self.subTest(file=suffix):
                    simple.ResetSession()
                    simple.LoadPlugin(PLUGIN, remote=False, ns=globals())
                    grid = hexes()
                    morph = MorphInversionFree(Input=grid, Boundary=moved(grid, WAVES), **values)
                    simple.RenameSource("kept", morph)
                    defaults = MorphInversionFree(Input=grid, Boundary=moved(grid, WAVES))
                    for name, value in values.items():
                        self.assertEqual(getattr(morph, name), value)
                        self.assertNotEqual(getattr(defaults, name), value, name)
                    updated(morph)
                    expected = points(morph)
                    state = str(Path(folder, "state" + suffix))
                    simple.SaveState(state)
                    script = Path(folder, "load.py")
                    script.write_text(LOADER, encoding="utf-8")
                    made = str(Path(folder, "points.npy"))
                    result = subprocess.run(
                        ["pvpython", "--force-offscreen-rendering", str(script), PLUGIN, state,
                         made, repr(values)],
                        capture_output=True, text=True, timeout=120)
                    self.assertEqual((result.returncode, result.stderr), (0, ""), result.stdout)
                    self.assertTrue(np.array_equal(np.load(made), expected))


# In a process of its own: nothing of the first session helps.
LOADER = '''
import sys
import numpy
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy
plugin, state, made, values = sys.argv[1:]
simple.LoadPlugin(plugin, remote=False, ns=vars(simple))
simple.LoadState(state)
morph = simple.FindSource("kept")
for name, value in eval(values).items():
    assert getattr(morph, name) == value, f"{name} is {getattr(morph, name)}, not {value}"
morph.UpdatePipeline()
numpy.save(made, vtk_to_numpy(servermanager.Fetch(morph).GetPoints().GetData()).astype(float))
'''


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
