# SPDX-License-Identifier: BSD-3-Clause
"""What a user tries first besides the twelve tasks of window_hand_tasks.py, in ParaView's window,
in one session: clicks are counted, and the panel's numbers are those of pvpython.

A click is one press of the mouse, each level of a menu included; the choice of an entry of a list
is two. Typing is counted apart.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> xvfb-run -s "-screen 0 1280x1024x24"
         pvpython window_tasks.py
"""
import os
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

from paraview import simple

from window_events import MAIN, PANEL, PROPERTIES, VIEW, field, rows
from window_morph_mesh import BOX, Clicks, text

PLUGIN = os.environ["MESHMORPHING_PLUGIN"]
simple.LoadPlugin(PLUGIN, remote=False, ns=globals())

MESH = Path(__file__).resolve().parents[2] / "Data/Models/small/canister_hex_small.vtu"
HOLE, WALL, LID = "Surface 0", "Surface 1", "Surface 3"
ASIDE = 0.6  # the hole, into the wall
NUMBERS = ("MinScaledJacobian", "MeanScaledJacobian", "InvertedCells", "WorstCellId")
HELP_PAGE = MAIN + "1pqHelpWindow0/1QTextBrowser0"
COLORS = MAIN + "variableToolbar/displayColor/Variables"
#: Lists of texts, which have no label of their own.
ZONES = {"FixedZones": "Fixed Zones", "RigidZones": "Rigid Zones", "SoftZones": "Soft Zones"}
ONE_INPUT = ("MorphMesh", "FitToSurface", "RepairMesh", "BoundaryDisplacement")
#: Of each task; numbers are typed besides.
CLICKS = {"move a surface that is pointed at": 5, "see which surface has which number": 2,
          "undo and redo": 4, "count and see inverted cells": 8, "an error keeps the picture": 6,
          "open the filter's page": 1}
NEITHER = ("Radius Change needs cylinders or spheres, and Surface 3 is neither. "
           "Choose such surfaces, or another displacement.")
class Tasks(Clicks):
    """Counts the clicks of each task, and keeps a picture of each step that changes what is
    seen."""

    def __init__(self):
        super().__init__()
        self.counted = {}
        self.name = None   # of the task
        self.pictured = 0  # how many lines the last picture shows

    def task(self, name):
        """The clicks from here on are those of this task."""
        self.counted[name] = -self.clicks
        self.name = name

    def done(self):
        self.counted[self.name] += self.clicks
        self.step("done")
        self.name = None

    def step(self, what):
        """A picture, which costs the task no click."""
        if self.name and len(self.lines) > self.pictured:
            self.shot(f"{self.name} {what}")
            self.pictured = len(self.lines)

    def menu(self, *arguments):
        super().menu(*arguments)
        if arguments[0] == "menu_Edit":
            self.step(arguments[1])

    def filter(self, name, menu=None):
        super().filter(name, menu)
        if name in ONE_INPUT:  # others open a dialog
            self.step(name)

    def toolbar(self, name):
        super().toolbar(name)
        self.clicks += 1
        self.step(name)

    def point(self, place, role):
        """At a surface in the view, with the right button, for its role."""
        self.press_in_view(place, button=2)
        self.step("menu")
        self.do("PipelineContextMenu", "activate", role)
        self.clicks += 2
        self.step(role)

    def apply(self):
        super().apply()
        self.step("apply")

    def tick(self, widget, row):
        super().tick(widget, row)
        self.step(f"tick {row}")

    def type(self, widget, text):
        super().type(widget, text)
        self.step(f"{widget.split('/')[0]} {text}")

    def select(self, *arguments):
        super().select(*arguments)
        self.clicks += 1
        self.step("select")

    def press(self, name):
        """A button of the panel."""
        self.set(name, "activate", "")
        self.clicks += 1
        self.step(name)

    def select_cells(self, *arguments):
        """A button of the view, and a rectangle."""
        super().select_cells(*arguments)
        self.clicks += 2
        self.step("cells")

    def choose(self, name, entry, widget="ComboBox"):
        """An entry of a list in the panel."""
        self.set(f"{name}/{widget}", "set_string", entry)
        self.clicks += 2
        self.step(entry)

    def toggle(self, name):
        """A tick of the panel, which was off."""
        self.set(f"{name}/CheckBox", "set_boolean", "true")
        self.clicks += 1
        self.step(name)

    def drag(self, first, last):
        """A box as a whole, with the middle button, in ten steps."""
        self.do(VIEW, "mousePress", f"({first[0]},{first[1]},4,4,0)")
        for step in range(1, 11):
            x, y = (a + (b - a) * step / 10 for a, b in zip(first, last))
            self.do(VIEW, "mouseMove", f"({x:.4f},{y:.4f},0,4,0)")
            if step == 6:
                self.step("drag")
        self.do(VIEW, "mouseRelease", f"({last[0]},{last[1]},4,0,0)")
        self.clicks += 1
        self.step("release")

    def saves(self, path):
        """A state, by the menu and a dialog in which the path is typed."""
        self.save_state(path)
        self.clicks += 3
        self.typed += 1

    def loads(self, path):
        """A state, in the same way; a second dialog asks where its files are."""
        self.menu("menu_File", "actionFileLoadServerState")
        self.do(MAIN + "FileLoadServerStateDialog", "filesSelected", str(path))
        self.do("LoadStateOptionsDialog/widget/OKButton", "activate")
        self.clicks += 2
        self.typed += 1

    def accept_inputs(self):
        """Of a filter with several inputs, as the dialog has them."""
        super().accept_inputs()
        self.clicks += 1
        self.step("inputs")

    def choose_input(self, port, place):
        super().choose_input(port, place)
        self.clicks += 1  # the port; what it gets is counted as a selection

    def shows(self, morph, names=NUMBERS):
        """The numbers of a filter of this process, without those that need an exponent: each
        version of ParaView writes it its own way."""
        for name in names:
            value = getattr(morph, name)
            if "e" not in text(value):
                self.expect(field(name, value), text(value))


def legend(state, array):
    """The names that the legend of an array gives its values, from a state."""
    root = ElementTree.parse(state).getroot()
    item = root.find(f".//ProxyCollection/Item[@name='{array}.PVLookupTable']")
    found = root.findall(f".//Proxy[@id='{item.get('id')}']/Property[@name='Annotations']/Element")
    texts = [element.get("value") for element in found]
    return dict(zip(texts[::2], texts[1::2]))


def bad_cells(morph):
    return morph.InvertedCells + morph.DegenerateCells


def visible(state):
    """The output ports of each filter that a state shows, by the filter's name, and the camera's
    focal point."""
    root = ElementTree.parse(state).getroot()
    names = {item.get("id"): item.get("name")
             for item in root.findall(".//ProxyCollection[@name='sources']/Item")}
    shown = {}
    for proxy in root.findall(".//Proxy[@group='representations']"):
        on = proxy.find("Property[@name='Visibility']/Element")
        source = proxy.find("Property[@name='Input']/Proxy")
        if on is not None and on.get("value") == "1" and source is not None:
            name = names.get(source.get("value"))
            shown.setdefault(name, set()).add(int(source.get("output_port")))
    focus = root.findall(".//Proxy[@group='views']/Property[@name='CameraFocalPoint']/Element")
    return shown, [float(one.get("value")) for one in focus]


class WindowTasks(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.mesh = simple.OpenDataFile(str(MESH))
        cls.mesh.UpdatePipeline()
        cls.names = rows(MorphMesh(Input=cls.mesh).GetProperty("Surfaces").GetAvailable())

    def expected(self, **properties):
        morph = MorphMesh(Input=self.mesh, **properties)
        morph.UpdatePipeline()
        self.assertIn(morph.MorphStatus, ("Valid", "Repaired"))
        self.assertEqual(morph.InvertedCells, 0)
        return morph

    def goes_on(self, events):
        """After an error: with the hole in place of the lid, which comes first in the table."""
        message = f"{PANEL}SurfaceTable/Message"
        events.press("SurfaceTable/AddSelected")
        events.expect(message, "true", "visible")  # nothing is selected
        for row in (0, 1):
            events.tick("SurfaceTable/Rows", row)
        events.expect(f"{PANEL}Advice/SaveAsShape", "true", "enabled")  # it applies
        events.apply()
        events.expect(COLORS, "ScaledJacobian", "currentText")
        events.expect(message, "false", "visible")
        events.expect(f"{PANEL}Advice/SaveAsShape", "true", "enabled")

    def row(self, surface):
        return self.names.index(surface)

    def test_tasks(self):
        wider = self.expected(Surfaces=[HOLE], Displacement="Radius", RadiusChange=0.1)
        bounds = wider.GetDataInformation().GetBounds()
        for bound, wanted in zip(bounds, (-1, 1, -1, 1, 0, 2.2)):  # the wall stays
            self.assertAlmostEqual(bound, wanted, delta=1e-6)
        inverted = MorphMesh(Input=self.mesh, Surfaces=[HOLE], Validity="Report")
        inverted.Transform.Translate = [ASIDE, 0, 0]
        inverted.UpdatePipeline()
        self.assertGreater(inverted.InvertedCells, 0)
        lifted = MorphMesh(Input=self.mesh, Surfaces=[LID])
        lifted.Transform.Translate = [0, 0, 0.1]
        lifted.UpdatePipeline()
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            events = Tasks()
            events.load_plugin(PLUGIN)
            events.open(str(MESH))
            events.clicks = 0

            events.task("move a surface that is pointed at")
            events.toolbar("MorphMesh")
            events.point((0.6, 0.5), "Moves")  # on the lid, which is in front
            events.type(BOX + "translateZ", "0.1")
            events.apply()
            events.done()
            events.shows(lifted)

            events.select("/0:0/0:0")
            events.task("see which surface has which number")
            events.toolbar("MorphMesh")
            events.apply()
            events.done()
            events.expect(COLORS, "SurfaceId", "currentText")
            events.expect(f"{PANEL}MinScaledJacobian/DoubleLineEdit0", "-1")
            for zones, label in ZONES.items():
                events.expect(f"{PANEL}{zones}/PanelLabel", label)

            events.select("/0:0/0:0")
            events.toolbar("MorphMesh")
            events.tick("SurfaceTable/Rows", self.row(HOLE))
            events.choose("Displacement", "Radius")
            events.type("RadiusChange/DoubleLineEdit0", "0.1")
            events.apply()
            events.shows(wider)
            events.expect(COLORS, "ScaledJacobian", "currentText")

            events.task("undo and redo")
            # ParaView 5.13 loses what is undone at once.
            events.save_state(folder / "applied.pvsm")
            events.menu("menu_Edit", "actionEditUndo")
            events.menu("menu_Edit", "actionEditRedo")
            events.done()
            events.shows(wider)

            events.select("/0:0/0:0")
            events.task("count and see inverted cells")
            events.toolbar("MorphMesh")
            events.tick("SurfaceTable/Rows", self.row(HOLE))
            events.type(BOX + "translateX", str(ASIDE))
            events.unfold("Methodsoptions")
            events.choose("Validity", "Report")
            events.apply()
            events.expect(f"{PANEL}Advice/BadCells", f"{bad_cells(inverted)} bad cells")
            events.press("Advice/BadCells")
            events.done()
            events.expect(f"{PANEL}Advice/BadCells", "Show the mesh")
            events.shows(inverted)
            events.expect(COLORS, "ScaledJacobian", "currentText")
            events.save_state(folder / "bad.pvsm")
            events.press("Advice/BadCells")

            events.select("/0:0/0:0")
            events.task("an error keeps the picture")
            events.toolbar("MorphMesh")
            events.tick("SurfaceTable/Rows", self.row(LID))
            events.choose("Displacement", "Radius")
            events.type("RadiusChange/DoubleLineEdit0", "0.1")
            events.apply()
            events.done()
            events.expect(f"{PANEL}InvertedCells/Number", "-1")
            events.expect(f"{PANEL}RadiusChange/Message0/Text", NEITHER)
            events.expect(f"{PANEL}Advice/SaveAsShape", "false", "enabled")
            self.goes_on(events)

            # Last: its window covers the other.
            events.task("open the filter's page")
            events.do(PROPERTIES + "Help", "activate")
            events.clicks += 1
            events.done()
            events.expect(HELP_PAGE, "qthelp://meshmorphing.org/MeshMorphing/"
                          "filters.MorphMesh.html", "source")
            events.expect(HELP_PAGE, "Morph Mesh", "documentTitle")

            events.save_state(folder / "state.pvsm")
            code, messages = events.play(folder)
            self.assertEqual(code, 0, messages)
            self.assertEqual(messages.count("ERR|"), 0, messages)  # the panel has it
            self.assertNotIn("FORWARD_DIRECTION", messages)
            self.assertEqual(events.counted, CLICKS)
            shown, focus = visible(folder / "bad.pvsm")
            self.assertEqual(shown["MorphMesh4"], {1})
            bounds = inverted.SMProxy.GetDataInformation(1).GetBounds()
            for place, low, high in zip(focus, bounds[::2], bounds[1::2]):
                self.assertAlmostEqual(place, (low + high) / 2, delta=1e-6)
            surfaces = [name for name in self.names if name.startswith("Surface")]
            self.assertEqual(legend(folder / "state.pvsm", "SurfaceId"),
                             {name.split()[1]: name for name in surfaces})
            own = set(simple.GetSources())
            simple.LoadState(str(folder / "state.pvsm"))
            again, = (source for key, source in simple.GetSources().items()
                      if key not in own and key[0] == "MorphMesh3")
            again.UpdatePipeline()
            for number in NUMBERS:
                self.assertEqual(getattr(again, number), getattr(wider, number))


if __name__ == "__main__":
    unittest.main()
