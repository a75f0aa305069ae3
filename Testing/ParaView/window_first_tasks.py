# SPDX-License-Identifier: BSD-3-Clause
"""More of what a user tries first, in ParaView's window: a fit to an STL file, cells selected
before the filter, an Exodus file, a filter without its boundary, methods compared. Clicks are
counted as in window_tasks.py, and the panel's numbers are those of pvpython.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> xvfb-run -s "-screen 0 1280x1024x24"
         pvpython window_first_tasks.py
"""
import os
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
from paraview import servermanager, simple
from paraview.vtk.util.numpy_support import vtk_to_numpy

from versions import BOX_FIELDS, blocks_for_exodus
from window_events import PANEL, rows
from window_morph_mesh import BOX, text
from window_tasks import COLORS, NUMBERS, Tasks

PLUGIN = os.environ["MESHMORPHING_PLUGIN"]
simple.LoadPlugin(PLUGIN, remote=False, ns=globals())

SMALL = Path(__file__).resolve().parents[2] / "Data/Models/small"
BORE, CANISTER = SMALL / "bore_hex_small.vtu", SMALL / "canister_hex_small.vtu"
TARGET = "coords*1.05 + 0.02*sin(coordsZ)*iHat"
DISTANCES = ("MaxTargetDistanceBefore", "MeanTargetDistanceBefore", "MaxTargetDistance",
             "MeanTargetDistance")
TOP, UP = "Surface 1", "0.2"
LID = "Surface 3"
REGION = f"Region/ProxySelectionWidget/frame/ChosenProxyWidget/InteractiveBox/{BOX_FIELDS}"


def series_colors(state):
    """Of the lines of the chart, from a state."""
    root = ElementTree.parse(state).getroot()
    found = root.findall(".//Property[@name='SeriesColor']/Element")
    texts = [element.get("value") for element in found]
    return {name: tuple(texts[4 * i + 1:4 * i + 4]) for i, name in enumerate(texts[::4])}


def updated(morph):
    morph.UpdatePipeline()
    return morph


class FirstTasks(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.events = Tasks()
        self.events.load_plugin(PLUGIN)

    def play(self, clicks, errors=0):
        """Plays what was recorded; returns the messages."""
        (self.folder / "home").mkdir()
        code, messages = self.events.play(self.folder / "home")
        self.assertEqual(code, 0, messages)
        self.assertEqual(messages.count("ERR|"), errors, messages)
        self.assertEqual(self.events.counted, clicks)
        return messages

    def open(self, *paths):
        for path in paths:
            self.events.open(str(path))
        self.events.clicks = 0

    def names(self, path):
        """In the order of the table."""
        mesh = simple.OpenDataFile(str(path))
        mesh.UpdatePipeline()
        return mesh, rows(MorphMesh(Input=mesh).GetProperty("Surfaces").GetAvailable())

    def test_fit_to_an_stl_file(self):
        mesh = simple.OpenDataFile(str(CANISTER))
        moved = simple.Calculator(Input=simple.ExtractSurface(Input=mesh), CoordinateResults=1,
                                  Function=TARGET)
        stl = self.folder / "part.stl"
        simple.SaveData(str(stl), proxy=simple.Triangulate(Input=moved))
        fit = updated(FittoSurface(Input=mesh, Target=simple.OpenDataFile(str(stl))))
        self.assertIn(fit.MorphStatus, ("Valid", "Repaired"))
        self.assertLess(fit.MaxTargetDistance, 1e-6)
        self.assertGreater(fit.MeanTargetDistanceBefore, 1e-2)

        self.open(stl, CANISTER)
        self.events.task("fit to a surface")
        self.events.filter("FitToSurface")
        self.events.choose("Target", "part.stl", "1QComboBox0")
        self.events.apply()
        self.events.done()
        self.events.shows(fit)
        self.events.shows(fit, DISTANCES)
        self.play({"fit to a surface": 6})

    def test_colors_after_nothing_was_ticked(self):
        mesh, names = self.names(BORE)
        morph = MorphMesh(Input=mesh, Surfaces=[TOP])
        morph.Transform.Translate = [0, 0, float(UP)]
        self.open(BORE)
        self.events.task("see the surfaces, then move one")
        self.events.filter("MorphMesh")
        self.events.apply()
        self.events.expect(COLORS, "SurfaceId", "currentText")
        self.events.tick("SurfaceTable/Rows", names.index(TOP))
        self.events.type(BOX + "translateZ", UP)
        self.events.apply()
        self.events.done()
        self.events.shows(updated(morph))
        self.events.expect(COLORS, "ScaledJacobian", "currentText")
        self.play({"see the surfaces, then move one": 7})

    def test_cells_selected_before_the_filter(self):
        self.open(BORE)
        self.events.select_cells((0.3, 0.4), (0.4, 0.6))
        self.events.task("move what is selected")
        self.events.filter("MorphMesh")
        self.events.type(BOX + "translateX", "0.05")
        self.events.apply()
        self.events.done()
        self.events.expect(f"{PANEL}MorphStatus/MorphStatus", "Valid")
        state = self.folder / "state.pvsm"
        self.events.save_state(state)
        self.play({"move what is selected": 5})
        simple.ResetSession()
        simple.LoadState(str(state))
        morph = updated(simple.FindSource("MorphMesh1"))
        self.assertEqual(morph.MorphStatus, "Valid")
        moved = vtk_to_numpy(servermanager.Fetch(morph).GetPointData().GetArray(
            "MorphDisplacement"))
        asked = np.abs(moved - (0.05, 0, 0)).max(axis=1) < 1e-6
        self.assertTrue(8 <= asked.sum() < len(asked) / 4, asked.sum())

    def test_the_box_turns_about_its_center(self):
        mesh, names = self.names(CANISTER)
        turned = updated(MorphMesh(Input=mesh, Surfaces=[LID], Rotation=[5, 0, 0],
                                   Displacement="Translate, rotate, scale"))
        self.assertEqual(turned.MorphStatus, "Valid")
        self.open(CANISTER)
        self.events.task("turn a surface")
        self.events.filter("MorphMesh")
        self.events.tick("SurfaceTable/Rows", names.index(LID))
        self.events.type(BOX + "rotateX", "5")
        self.events.apply()
        self.events.done()
        state = self.folder / "state.pvsm"
        self.events.save_state(state)
        self.play({"turn a surface": 6})
        least, bounds = turned.MinScaledJacobian, turned.GetDataInformation().GetBounds()
        simple.ResetSession()
        simple.LoadState(str(state))
        morph = updated(simple.FindSource("MorphMesh1"))
        self.assertGreater(morph.Transform.Translate[1], 0.1)  # what keeps the center
        self.assertAlmostEqual(morph.MinScaledJacobian, least, delta=1e-9)
        for bound, wanted in zip(morph.GetDataInformation().GetBounds(), bounds):
            self.assertAlmostEqual(bound, wanted, delta=1e-9)

    def test_a_surface_dragged_live(self):
        mesh, names = self.names(BORE)
        mesh.UpdatePipeline()
        self.open(BORE)
        self.events.task("drag a surface")
        self.events.filter("MorphMesh")
        self.events.tick("SurfaceTable/Rows", names.index(TOP))
        self.events.toggle("Displacement/LiveDrag")
        self.events.apply()
        self.events.drag((0.5, 0.5), (0.53, 0.52))
        self.events.done()
        state = self.folder / "state.pvsm"
        self.events.save_state(state)
        messages = self.play({"drag a surface": 7})
        self.assertNotIn("repair", messages.lower())
        simple.ResetSession()
        simple.LoadState(str(state))
        morph = updated(simple.FindSource("MorphMesh1"))
        self.assertEqual(morph.MorphStatus, "Valid")
        self.assertEqual((morph.Live, morph.Quality), (0, "All"))  # as before the drag
        self.assertGreater(np.linalg.norm(morph.Transform.Translate), 0.01)

    def test_a_region_dragged_live(self):
        """The blue box says what moves; it lies inside the orange one, which moves it."""
        self.open(BORE)
        self.events.task("drag a region")
        self.events.filter("MorphMesh")
        self.events.choose("SurfaceTable", "Region", "Moving")
        self.events.type(REGION + "scaleX", "3")
        self.events.toggle("Displacement/LiveDrag")
        self.events.apply()
        self.events.drag((0.5, 0.5), (0.52, 0.51))
        self.events.done()
        state = self.folder / "state.pvsm"
        self.events.save_state(state)
        self.play({"drag a region": 9})
        simple.ResetSession()
        simple.LoadState(str(state))
        morph = updated(simple.FindSource("MorphMesh1"))
        self.assertEqual(list(morph.Region.Length)[0], 3)
        self.assertEqual((morph.Live, morph.Quality), (0, "All"))
        dragged = np.array(morph.Transform.Translate)
        self.assertGreater(np.linalg.norm(dragged), 0.01)
        again = MorphMesh(Input=morph.Input, Moving="Region", Region="Box")
        again.Region.Position, again.Region.Length = morph.Region.Position, morph.Region.Length
        again.Transform.Translate = dragged
        updated(again)
        for name in NUMBERS:
            self.assertEqual(getattr(morph, name), getattr(again, name))

    def test_a_state_is_saved_and_loaded(self):
        mesh, names = self.names(BORE)
        morph = MorphMesh(Input=mesh, Surfaces=[TOP])
        morph.Transform.Translate = [0, 0, float(UP)]
        updated(morph)
        self.open(BORE)
        self.events.filter("MorphMesh")
        self.events.tick("SurfaceTable/Rows", names.index(TOP))
        self.events.type(BOX + "translateZ", UP)
        self.events.apply()
        self.events.task("save a state")
        self.events.saves(self.folder / "state.pvsm")
        self.events.done()
        self.events.menu("menu_Edit", "actionDelete_All")
        self.events.task("load a state")
        self.events.loads(self.folder / "state.pvsm")
        self.events.done()
        self.events.select("/0:0/0:0/0:0")
        self.events.shows(morph)
        self.events.expect(f"{PANEL}MorphStatus/MorphStatus", "Valid")
        self.play({"save a state": 3, "load a state": 4})
        least = morph.MinScaledJacobian
        simple.ResetSession()
        simple.LoadState(str(self.folder / "state.pvsm"))
        again = updated(simple.FindSource("MorphMesh1"))
        self.assertEqual(again.MinScaledJacobian, least)

    def test_two_shapes_with_sliders(self):
        mesh, names = self.names(BORE)
        shapes = []
        for up in ("0.2", "0.4"):
            morph = MorphMesh(Input=mesh, Surfaces=[TOP])
            morph.Transform.Translate = [0, 0, float(up)]
            shapes.append(simple.OutputPort(morph, 2))
        blend = updated(MorphShapes(Input=mesh, Shapes=shapes, Weights=[0.5, 0.25]))
        self.assertEqual(blend.MorphStatus, "Valid")
        self.open(BORE)
        self.events.task("two shapes with sliders")
        self.events.toolbar("MorphMesh")
        self.events.tick("SurfaceTable/Rows", names.index(TOP))
        self.events.type(BOX + "translateZ", "0.2")
        self.events.press("Advice/SaveAsShape")
        self.events.select("/0:0/0:0/0:0")
        self.events.type(BOX + "translateZ", "0.4")
        self.events.press("Advice/SaveAsShape")
        for shape, place in (("Slider0", "750"), ("Slider1", "625")):  # 0 is -1, 1000 is 1
            self.events.set(f"Weights/{shape}", "set_int", place)
            self.events.clicks += 1
        self.events.apply()
        self.events.done()
        self.events.shows(blend, ("MinScaledJacobian", "InvertedCells"))
        state = self.folder / "state.pvsm"
        self.events.save_state(state)
        self.play({"two shapes with sliders": 10})
        simple.ResetSession()
        simple.LoadState(str(state))
        lifts = [simple.FindSource(name).Transform.Translate[2] for name in ("Shape1", "Shape2")]
        self.assertEqual(lifts, [0.2, 0.4])
        self.assertEqual(len(simple.FindSource("MorphShapes1").Shapes), 2)

    def test_exodus(self):
        mesh = simple.OpenDataFile(str(BORE))
        file = self.folder / "part.ex2"
        simple.SaveData(str(file), proxy=blocks_for_exodus(simple.GroupDatasets(Input=mesh)))
        blocks, names = self.names(file)
        morph = MorphMesh(Input=blocks, Surfaces=[TOP])
        morph.Transform.Translate = [0, 0, float(UP)]
        self.assertEqual(updated(morph).MorphStatus, "Valid")
        self.open(file)
        self.events.task("morph an Exodus file")
        self.events.filter("MorphMesh")
        self.events.tick("SurfaceTable/Rows", names.index(TOP))
        self.events.type(BOX + "translateZ", UP)
        self.events.apply()
        self.events.done()
        self.events.shows(morph)
        self.events.expect(COLORS, "ScaledJacobian", "currentText")
        self.play({"morph an Exodus file": 6})

    def test_a_method_without_its_boundary(self):
        self.open(BORE)
        self.events.task("a method alone")
        self.events.filter("MorphFEMWARP")
        self.events.accept_inputs()
        self.events.apply()
        self.events.done()
        self.events.expect(f"{PANEL}MorphStatus/MorphStatus", "Failed")
        self.events.expect(f"{PANEL}InvertedCells/Number", "-1")
        messages = self.play({"a method alone": 5}, errors=1)
        self.assertIn("Connect Boundary Displacement", messages)
        self.assertNotIn("FORWARD_DIRECTION", messages)

    def test_compare_methods(self):
        mesh, names = self.names(BORE)
        moved = BoundaryDisplacement(Input=mesh, Moving="Surfaces", Surfaces=[TOP],
                                     Displacement="Vector",
                                     Vector=[0, 0, 1.5], Surroundings="Stay")
        best = updated(CompareMorphMethods(Input=mesh, Boundary=moved)).BestMethod
        self.assertEqual(best, "Inversion-free")  # the only valid one
        self.open(BORE)
        self.events.filter("BoundaryDisplacement")
        self.events.choose("SurfaceTable", "Surfaces", "Moving")
        self.events.tick("SurfaceTable/Rows", names.index(TOP))
        self.events.choose("Displacement", "Vector")
        self.events.type("Vector/DoubleLineEdit2", "1.5")
        self.events.choose("Surroundings", "Stay")
        self.events.apply()
        self.events.select("/0:0/0:0")
        self.events.task("compare the methods")
        self.events.filter("CompareMorphMethods")
        self.events.choose_input("Boundary", "/0:0/0:0/0:0")
        self.events.apply()
        self.events.done()
        self.events.expect(f"{PANEL}BestMethod/BestMethod", best)
        state = self.folder / "state.pvsm"
        self.events.save_state(state)
        self.play({"compare the methods": 7})
        views = [proxy.get("type") for proxy in ElementTree.parse(state).getroot().findall(
            ".//Proxy[@group='views']")]
        self.assertEqual(sorted(views), ["RenderView", "SpreadSheetView", "XYChartView"])
        colors = series_colors(state)
        methods = [name for name in colors if name.endswith(", Absolute")]
        self.assertEqual(len(methods), 8)
        self.assertEqual(len({colors[name] for name in methods}), 8)  # told apart


if __name__ == "__main__":
    unittest.main()
