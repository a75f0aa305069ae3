# SPDX-License-Identifier: BSD-3-Clause
"""ParaView's window itself: load the plugin, morph a mesh by menus and dialogs, read the numbers in
the panel, undo, redo, save a trace and states. pvpython gets the same numbers to the last bit, by
itself and from what was saved.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> xvfb-run -s "-screen 0 1280x1024x24"
         pvpython window.py
"""
import os
import runpy
import tempfile
import unittest
from pathlib import Path

from paraview import simple

from versions import HAS_SCRIPT_EDITOR
from window_events import MAIN, PANEL, Events, field

PLUGIN = os.environ["MESHMORPHING_PLUGIN"]
simple.LoadPlugin(PLUGIN, remote=False, ns=globals())

MESH = Path(__file__).resolve().parents[2] / "Data/Models/small/bore_hex_small.vtu"
BENT = "coords+0.9*coordsX*sin(coordsZ/1.5)*jHat"
FOLDED = "coords+2*sin(coordsX*2)*sin(coordsZ)*jHat"
SCALE = "ScaleFactor/DoubleRangeWidget/DoubleLineEdit"
NUMBERS = ("ScaleFactor", "MinScaledJacobian", "MeanScaledJacobian", "InvertedCells",
           "WorstCellId", "LargestValidStep")


def numbers():
    """Of the morphed mesh in this process, a text for each."""
    morph = simple.FindSource("MorphFEMWARP1")
    morph.UpdatePipeline()
    return [repr(float(getattr(morph, name))) for name in NUMBERS]


def built(function, scale):
    """The numbers of the mesh that the window is to show."""
    simple.ResetSession()
    part = simple.OpenDataFile(str(MESH))
    moved = simple.Calculator(Input=ExtractMorphBoundary(Input=part), CoordinateResults=1,
                              Function=function)
    MorphFEMWARP(registrationName="MorphFEMWARP1", Input=part, Boundary=moved, ScaleFactor=scale)
    return numbers()


def loaded(path):
    """The numbers after a trace or state was played."""
    simple.ResetSession()
    if path.suffix == ".py":
        runpy.run_path(str(path))
    else:
        simple.LoadState(str(path))
    return numbers()


class Window(unittest.TestCase):
    def test_morph_by_menus_and_dialogs(self):
        whole, half, folded = built(BENT, 1), built(BENT, 0.5), built(FOLDED, 0.5)
        self.assertEqual((whole[3], half[3]), ("0.0", "0.0"))
        self.assertGreater(float(folded[3]), 0)
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            events = Events()
            events.load_plugin(PLUGIN)
            if HAS_SCRIPT_EDITOR:
                events.menu("menuTools", "actionToolsStartStopTrace")
                events.do("TraceOptionsDialog/widget/OKButton", "activate")
            events.open(str(MESH))
            events.filter("ExtractMorphBoundary")
            events.apply()
            events.filter("Calculator", "Alphabetical")
            events.set("CoordinateResults/CheckBox", "set_boolean", "true")
            events.set("Function/Function/OneLiner", "set_string", BENT)
            events.apply()
            events.select("/0:0/0:0")
            events.filter("MorphFEMWARP")
            events.choose_input("Boundary", "/0:0/0:0/0:0/0:0")
            events.apply()
            self.expect(events, whole)
            events.set(SCALE, "set_string", "0.5")
            events.apply()
            self.expect(events, half)
            events.menu("menu_Edit", "actionEditUndo")
            events.expect(PANEL + SCALE, "1")
            events.menu("menu_Edit", "actionEditRedo")
            events.expect(PANEL + SCALE, "0.5")
            if HAS_SCRIPT_EDITOR:
                events.menu("menuTools", "actionToolsStartStopTrace")
                editor = MAIN + "1pqPythonScriptEditor0/"
                events.do(editor + "PythonScriptEditorMenuBar", "activate", "File")
                events.do(editor + "PythonScriptEditorMenuBar/File", "activate", "Save &As...")
                events.do(editor + "FileOpenDialog", "filesSelected", str(folder / "trace.py"))

            events.select("/0:0/0:0/0:0/0:0")
            events.set("Function/Function/OneLiner", "set_string", FOLDED)
            events.apply()
            events.select("/0:0/1:0/0:0")
            self.expect(events, folded)
            for state in ("state.pvsm", "state.py"):
                events.menu("menu_File", "actionFileSaveServerState")
                events.do(MAIN + "FileSaveServerStateDialog", "filesSelected", str(folder / state))
            events.do("StateOptionsDialog/widget/OKButton", "activate")

            code, messages = events.play(folder)
            self.assertEqual(code, 0, messages)
            # The ten worst cells and nothing else, once for both outputs.
            self.assertEqual(messages.count("cells are inverted or degenerate"), 1, messages)
            self.assertEqual(messages.count("\n  cell "), 10, messages)
            self.assertNotIn("ERR|", messages)
            if HAS_SCRIPT_EDITOR:
                self.assertEqual(loaded(folder / "trace.py"), half)
            self.assertEqual(loaded(folder / "state.py"), folded)
            self.assertEqual(loaded(folder / "state.pvsm"), folded)
            # Empty at first, and colored all the same once there are any.
            morph = simple.FindSource("MorphFEMWARP1").SMProxy
            bad = [list(one.ColorArrayName) for one in simple.GetActiveView().Representations
                   if hasattr(one, "ColorArrayName") and one.Input.SMProxy == morph
                   and one.Input.Port == 1]
            self.assertEqual(bad, [["CELLS", "ScaledJacobian"]])

    def expect(self, events, texts):
        """In the panel, with all digits."""
        for name, text in zip(NUMBERS, texts):
            place = field(name, 0 if name.endswith(("Cells", "Points", "Id")) else 0.5)
            place = PANEL + SCALE if name == "ScaleFactor" else place
            events.expect(place, text[:-2] if text.endswith(".0") else text)


if __name__ == "__main__":
    unittest.main()
