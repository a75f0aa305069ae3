# SPDX-License-Identifier: BSD-3-Clause
"""Morph Mesh in ParaView's window: six clicks from an open mesh to a morphed one, with the numbers
of pvpython; nothing ticked, or no handle given, which is no error. A click is one press of the
mouse, each level of a menu included; typing is counted apart.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> xvfb-run -s "-screen 0 1280x1024x24"
         pvpython window_morph_mesh.py
"""
import os
import tempfile
import unittest
from pathlib import Path

from paraview import simple

from versions import BOX_FIELDS
from window_events import PANEL, Events, field, rows

PLUGIN = os.environ["MESHMORPHING_PLUGIN"]
simple.LoadPlugin(PLUGIN, remote=False, ns=globals())

MESH = Path(__file__).resolve().parents[2] / "Data/Models/small/bore_hex_small.vtu"
SURFACE, UP = "Surface 1", "0.2"
NUMBERS = ("MinScaledJacobian", "MeanScaledJacobian", "InvertedCells", "WorstCellId",
           "LargestValidStep")
BOX = f"Transform/ProxySelectionWidget/frame/ChosenProxyWidget/InteractiveBox/{BOX_FIELDS}"

KIND = "Transform/ProxySelectionWidget/comboBox"


class Clicks(Events):
    """Counts what a user presses and types."""

    def __init__(self):
        super().__init__()
        self.clicks = self.typed = 0

    def menu(self, menu, action):
        super().menu(menu, action)
        self.clicks += len(menu.split("/")) + 1

    def apply(self):
        super().apply()
        self.clicks += 1

    def tick(self, widget, row):
        """The box at the left of a row of a list."""
        for command, buttons in (("mousePress", "1,1"), ("mouseRelease", "1,0")):
            self.set(widget, command, f"{buttons},0,12,8,/{row}:0")
        self.clicks += 1

    def unfold(self, title):
        """A title of the panel: its group opens."""
        self.set("Fold" + title, "activate", "")
        self.clicks += 1

    def type(self, widget, text):
        """A click into the field, and a text."""
        self.set(widget, "set_string", text)
        self.clicks += 1
        self.typed += 1


def text(value):
    """As the panel shows it."""
    shown = repr(float(value))
    return shown[:-2] if shown.endswith(".0") else shown


class MorphMeshInTheWindow(unittest.TestCase):
    def test_six_clicks(self):
        part = simple.OpenDataFile(str(MESH))
        morph = MorphMesh(Input=part, Surfaces=[SURFACE])
        morph.Transform.Translate = [0, 0, float(UP)]
        morph.UpdatePipeline()
        self.assertEqual(morph.MorphStatus, "Valid")
        self.assertEqual(morph.InvertedCells, 0)
        names = list(morph.GetProperty("Surfaces").GetAvailable())
        nothing, without_handle = MorphMesh(Input=part), MorphMesh(Input=part,
                                                                   Displacement="Handles")
        for one, advice in ((nothing, "Tick surfaces"), (without_handle, "Give a handle")):
            one.UpdatePipeline()
            self.assertIn(advice, one.Advice)
            self.assertEqual(one.MorphStatus, "None")
        with tempfile.TemporaryDirectory() as name:
            events = Clicks()
            events.load_plugin(PLUGIN)
            events.open(str(MESH))
            events.clicks = 0
            events.filter("MorphMesh")
            events.tick("SurfaceTable/Rows", rows(names).index(SURFACE))
            events.type(BOX + "translateZ", UP)
            events.apply()
            self.assertEqual((events.clicks, events.typed), (6, 1))
            for number in NUMBERS:
                value = getattr(morph, number)
                events.expect(field(number, value), text(value))

            events.select("/0:0/0:0")
            events.filter("MorphMesh")
            events.apply()  # nothing is ticked
            events.expect(f"{PANEL}MinScaledJacobian/DoubleLineEdit0", "-1")
            events.expect(f"{PANEL}Advice/Text", nothing.Advice)
            events.set("Displacement/ComboBox", "set_string", "Handles")
            events.apply()  # and there is no handle
            events.expect(f"{PANEL}Advice/Text", without_handle.Advice)
            events.shot("no handle")
            events.set("Displacement/ComboBox", "set_string", "Transform")
            events.set(KIND, "set_string", "Rotation about a point")
            events.apply()
            events.save_state(Path(name) / "state.pvsm")
            code, messages = events.play(Path(name))
            self.assertEqual(code, 0, messages)
            self.assertNotIn("ERR|", messages)
            self.assertNotIn("rror:", messages)
            simple.ResetSession()
            simple.LoadState(str(Path(name) / "state.pvsm"))
            self.assertEqual(simple.FindSource("MorphMesh2").Transform.GetXMLName(),
                             "RotateAroundOriginTransform")


if __name__ == "__main__":
    unittest.main()
