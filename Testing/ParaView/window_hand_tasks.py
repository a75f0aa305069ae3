# SPDX-License-Identifier: BSD-3-Clause
"""Tasks of a first-time user in ParaView's window, by a real mouse and keyboard
(window_hands.py). Each is counted, and its result is that of pvpython where numbers are typed.

A press and release, a drag, a value that is typed, and a key count one each. A task that begins
with "then" goes on with the filter of the one before.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> MESHMORPHING_PANEL_ROWS=<path of its library>
         xvfb-run -s "-screen 0 1280x1024x24" pvpython window_hand_tasks.py
"""
import os
import tempfile
import unittest
from pathlib import Path

from paraview import simple

from window_hands import Hands, picture

PLUGIN = os.environ["MESHMORPHING_PLUGIN"]
simple.LoadPlugin(PLUGIN, remote=False, ns=globals())

SMALL = Path(__file__).resolve().parents[2] / "Data/Models/small"
CANISTER = SMALL / "canister_hex_small.vtu"
HOLE, LID = "Surface 0", "Surface 3"
#: Of each task, in the order of the tutorial's table.
COUNTS = {"enlarge a hole": 7, "bend by the box": 4, "then drag live": 2, "fit to an STL file": 2,
          "then keep layers": 4, "then freeze a zone": 2, "repair a tangled mesh": 2}
MOST_OF_ONE = 9
PANEL = "propertiesDock/ProxyPanel/"
STATUS, ROWS = PANEL + "Advice/Status", PANEL + "SurfaceTable/Rows"
MIDDLE = 2  # button
TANGLED = ("coords + 0.3*sin(coordsZ*3.14159/2.2)*sin((sqrt(coordsX^2 + coordsY^2) - 0.25)*3.14159/"
           "0.75)*sin(19*coordsX)*sin(23*coordsY)*(iHat + jHat + kHat)")


def done(text):
    return text.startswith(("Valid", "Repaired"))


def status(morph):
    """What the first line of the panel says."""
    morph.UpdatePipeline()
    return f"{morph.MorphStatus}, minimum {morph.MinScaledJacobian:.3g}"


class HandTasks(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        try:
            self.hands = Hands(self.folder)
        except OSError as missing:
            self.skipTest(str(missing))
        self.addCleanup(self.hands.close)

    def open(self, path):
        """Not counted: the mesh is there."""
        self.hands.button("actionOpenData")
        self.hands.find("widget\tFileOpenDialog")
        self.hands.type(str(path), "Return")
        self.hands.button("Apply")

    def task(self, name, steps):
        """Counts what `steps` does."""
        self.hands.count = 0
        steps()
        picture(name)
        self.assertEqual(self.hands.count, COUNTS[name], name)
        self.assertLessEqual(self.hands.count, MOST_OF_ONE)

    def ended(self, accept=done):
        return self.hands.wait(STATUS, accept)

    def test_hole(self):
        hands, mesh = self.hands, simple.OpenDataFile(str(CANISTER))
        wider = MorphMesh(Input=mesh, Surfaces=[HOLE], Displacement="Radius", RadiusChange=0.1)
        self.open(CANISTER)

        def enlarge():
            hands.button("Morph Mesh")
            hands.tick(ROWS, HOLE)
            hands.choose(PANEL + "Displacement/ComboBox", "Radius")
            hands.fill(PANEL + "RadiusChange/DoubleLineEdit0", "0.1")
            hands.button("Apply")
            self.assertEqual(self.ended(), status(wider))
        self.task("enlarge a hole", enlarge)

    def test_bend_live_drag_and_layers(self):
        hands = self.hands
        marked = self.folder / "marked.vtu"
        simple.SaveData(str(marked), proxy=simple.Calculator(
            Input=simple.OpenDataFile(str(CANISTER)), ResultArrayName="Insert",
            Function="if(coordsZ < 0.3, 1, 0)"))
        self.open(marked)

        def bend():
            hands.button("Morph Mesh")
            hands.tick(ROWS, LID)
            hands.drag((0.6, 0.5), (0.62, 0.53))
            hands.button("Apply")
            self.ended()
        self.task("bend by the box", bend)

        def live():
            hands.press(PANEL + "LiveDrag/CheckBox")
            hands.drag((0.5, 0.5), (0.52, 0.51), MIDDLE)
            self.ended()
        self.task("then drag live", live)

        def layers():
            hands.press(PANEL + "FoldZonesandlayers")
            hands.fill(PANEL + "KeepLayers/LineEdit0", "2")
            hands.button("Apply")
            self.ended()
        self.task("then keep layers", layers)

        def freeze():
            hands.tick(PANEL + "FixedZones/ArraySelectionWidget", "Insert")
            hands.button("Apply")
            self.ended()
        self.task("then freeze a zone", freeze)

    def test_fit_and_repair(self):
        hands, mesh = self.hands, simple.OpenDataFile(str(CANISTER))
        tangled, scan = self.folder / "tangled.vtu", self.folder / "scan.stl"
        simple.SaveData(str(tangled), proxy=simple.Calculator(
            Input=mesh, CoordinateResults=1, Function=TANGLED))
        moved = simple.Calculator(Input=simple.ExtractSurface(Input=mesh), CoordinateResults=1,
                                  Function="coords*1.05")
        simple.SaveData(str(scan), proxy=simple.Triangulate(Input=moved))
        fit = FittoSurface(Input=mesh, Target=simple.OpenDataFile(str(scan)))
        repaired = RepairMesh(Input=simple.OpenDataFile(str(tangled)))
        self.open(scan)
        self.open(CANISTER)

        def fits():
            hands.button("Fit to Surface")
            hands.button("Apply")
            self.assertEqual(self.ended(), status(fit))
        self.task("fit to an STL file", fits)
        self.open(tangled)

        def repairs():
            hands.button("Repair Mesh")
            hands.button("Apply")
            self.assertEqual(self.ended(), status(repaired))
        self.task("repair a tangled mesh", repairs)


if __name__ == "__main__":
    unittest.main()
