# SPDX-License-Identifier: BSD-3-Clause
"""Twelve tasks of a first-time user in ParaView's window, by a real mouse and keyboard
(window_hands.py). Each is counted, and its result is that of pvpython where numbers are typed.

A press and release, a drag, a value that is typed, and a key count one each. A task that begins
with "then" goes on with the filter of the one before.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> MESHMORPHING_PANEL_ROWS=<path of its library>
         xvfb-run -s "-screen 0 1280x1024x24" pvpython window_hand_tasks.py
"""
import os
import tempfile
import time
import unittest
from pathlib import Path

from paraview import servermanager, simple

from window_hands import Hands, picture

PLUGIN = os.environ["MESHMORPHING_PLUGIN"]
simple.LoadPlugin(PLUGIN, remote=False, ns=globals())

SMALL = Path(__file__).resolve().parents[2] / "Data/Models/small"
CANISTER, COURIER = SMALL / "canister_hex_small.vtu", SMALL / "courier_hex_small.vtu"
HOLE, LID = "Surface 0", "Surface 3"
BOSS = "Surface 6, Surface 7"  # its top, and the hole in it
#: Of each task, in the order of the tutorial's table.
COUNTS = {"enlarge a hole": 7, "move a boss": 6, "bend by the box": 4, "then drag live": 2,
          "then keep layers": 4, "then freeze a zone": 2, "fit to an STL file": 2,
          "two shapes with sliders": 9, "then play 20 steps": 5,
          "then compare and take the best": 8, "repair a tangled mesh": 2,
          "morph an .inp file": 9}
MOST_OF_ONE, MOST_OF_ALL = 9, 60
PANEL = "propertiesDock/ProxyPanel/"
STATUS, ROWS = PANEL + "Advice/Status", PANEL + "SurfaceTable/Rows"
MOVED = [f"{PANEL}Transform/InteractiveBox/translate{axis}" for axis in "XYZ"]
MIDDLE = 2  # button
#: In the courier's first view: on its left boss, and in the box around that.
ON_BOSS, IN_BOX = ((0.28, 0.49), (0.37, 0.51)), (0.32, 0.53)
TANGLED = ("coords + 0.3*sin(coordsZ*3.14159/2.2)*sin((sqrt(coordsX^2 + coordsY^2) - 0.25)*3.14159/"
           "0.75)*sin(19*coordsX)*sin(23*coordsY)*(iHat + jHat + kHat)")


def done(text):
    return text.startswith(("Valid", "Repaired"))


def status(morph):
    """What the first line of the panel says."""
    morph.UpdatePipeline()
    return f"{morph.MorphStatus}, minimum {morph.MinScaledJacobian:.3g}"


def deck(path, mesh):
    """Writes the mesh, of hexahedra, as a deck of Abaqus."""
    mesh.UpdatePipeline()
    grid = servermanager.Fetch(mesh)
    lines = ["*NODE"]
    lines += [", ".join(map(str, (i + 1, *grid.GetPoint(i))))
              for i in range(grid.GetNumberOfPoints())]
    lines.append("*ELEMENT, TYPE=C3D8")
    for c in range(grid.GetNumberOfCells()):
        nodes = grid.GetCell(c).GetPointIds()
        lines.append(", ".join(str(i) for i in (c + 1, *(nodes.GetId(k) + 1 for k in range(8)))))
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


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
        hands.press(PANEL + "RadiusChange/DoubleLineEdit0", x=0.3)
        hands.key("Control_L", "a")
        hands.type("0.5", "Tab")  # the wall has a radius of 1
        hands.button("Apply")
        wider.RadiusChange = 0.5
        self.assertTrue(done(status(wider)))
        hands.wait(STATUS, status(wider).__eq__)

    def test_an_interface_of_blocks_moves(self):
        hands, parts = self.hands, self.folder / "parts.vtm"
        sides = [simple.AppendDatasets(Input=simple.Wavelet(WholeExtent=[*along, 0, 4, 0, 4]))
                 for along in ((0, 4), (4, 8))]
        blocks = simple.GroupDatasets(Input=sides, BlockNames=["Soft", "Stiff"])
        simple.SaveData(str(parts), blocks)
        moved = MorphMesh(Input=blocks, Surfaces=["Soft | Stiff"])
        moved.Transform.Translate = [0.5, 0, 0]
        self.open(parts)
        hands.button("Morph Mesh")
        hands.tick(ROWS, "Soft | Stiff")
        hands.fill(MOVED[0], "0.5")
        hands.key("Tab")  # else ParaView's box takes the first press elsewhere
        hands.button("Apply")
        self.assertEqual(self.ended(), status(moved))
        self.assertEqual(hands.messages(), "")  # the zones' lists have both blocks
        picture("an interface moves")

    def test_tab_behind_a_handle_adds_no_row(self):
        hands = self.hands
        self.open(CANISTER)
        hands.button("Morph Mesh")
        hands.choose(PANEL + "Displacement/ComboBox", "Handles")
        hands.press(PANEL + "Handles/Add")
        hands.press(PANEL + "Handles/Table", x=20, y=0.5)
        numbers = [1, 0, 1.1, 0.1, 0, 0, 0.5]  # place, displacement, radius
        for number in numbers:
            hands.type(str(number), "Tab")
        hands.button("Apply")
        one = MorphMesh(Input=simple.OpenDataFile(str(CANISTER)), Displacement="Handles",
                        Handles=numbers)
        self.assertEqual(self.ended(), status(one))  # two at one place would be an error

    def test_stop(self):
        """By the button beside the progress bar; what is pressed elsewhere meanwhile does nothing.
        Natural neighbors of 40^3 cells take long, as the nodes of a lattice tie."""
        hands, box = self.hands, self.folder / "box.vtu"
        cells = simple.Wavelet(WholeExtent=[0, 40, 0, 40, 0, 40])
        simple.SaveData(str(box), simple.AppendDatasets(Input=cells))
        self.open(box)
        hands.button("Morph Mesh")
        hands.tick(ROWS, "Surface 0")
        hands.choose(PANEL + "Method/ComboBox", "Simplex-natural neighbor")

        def button():
            return hands.find("widget\tAbortButton", enabled=False)

        stop = button()
        delete = hands.find("button\tDelete")
        self.assertFalse(stop["enabled"])
        hands.button("Apply")
        time.sleep(2)
        hands.press_at(delete)
        picture("stop")
        while hands.busy() or button()["enabled"]:  # ParaView 6.1 answers at work, too
            hands.press_at(stop)
        self.ended("Stopped: the mesh is undeformed".__eq__)
        self.assertFalse(button()["enabled"])

    def test_boss(self):
        hands = self.hands
        self.open(COURIER)

        def move():
            hands.button("Morph Mesh")
            hands.key("s")
            hands.drag(*ON_BOSS)
            hands.button("Add selected surfaces")
            hands.wait(PANEL + "SurfaceTable/Message", f"Moves: {BOSS}".__eq__)
            hands.drag(IN_BOX, (0.33, 0.53), MIDDLE)
            hands.button("Apply")
            self.ended()
        self.task("move a boss", move)
        moved = MorphMesh(Input=simple.OpenDataFile(str(COURIER)), Surfaces=BOSS.split(", "))
        moved.Transform.Translate = [float(hands.text(one)) for one in MOVED]
        self.assertGreater(moved.Transform.Translate[0], 0.1)
        self.assertEqual(hands.text(STATUS), status(moved))

    def test_shapes(self):
        hands = self.hands
        self.open(COURIER)

        def shapes():
            hands.button("Morph Mesh")
            hands.tick(ROWS, "Surface 6")
            for row, to in ((0, (0.33, 0.53)), (1, (0.32, 0.54))):
                if row:
                    hands.browser_row(2)  # back to Morph Mesh, whose box is around the boss
                hands.drag(IN_BOX, to, MIDDLE)
                hands.button("Save as Shape")
                hands.find(f"widget\t{PANEL}Weights/Slider{row}")
            for row in (0, 1):
                hands.slide(f"{PANEL}Weights/Slider{row}", 0.7)
                hands.wait(f"{PANEL}Weights/Weight{row}", lambda text: float(text) > 0.3)
        self.task("two shapes with sliders", shapes)
        for row in (0, 1):
            self.assertRegex(hands.text(f"{PANEL}Weights/Range{row}"), "^-.* to .*")
        self.assertFalse(hands.find("button\tApply", enabled=False)["enabled"])  # it was live

    def test_steps_and_compare(self):
        hands = self.hands
        self.open(CANISTER)
        hands.button("Morph Mesh")
        hands.tick(ROWS, LID)
        hands.drag((0.6, 0.5), (0.62, 0.53))
        hands.button("Apply")
        whole = self.ended()

        def steps():
            hands.press(PANEL + "FoldSteps")
            hands.fill(PANEL + "NumberOfSteps/LineEdit0", "20")
            hands.button("Apply")
            hands.wait("timestepValue", "0".__eq__)
            hands.button("actionVCRPlay")
            hands.wait("timestepValue", "20".__eq__)
            self.assertEqual(self.ended(), whole)
        self.task("then play 20 steps", steps)

        def compare():
            hands.browser_row(1)  # the mesh
            hands.button("Compare Morph Methods")
            hands.button("Boundary")
            hands.browser_row(4, "SelectInputDialog/pipelineView")  # Morph Mesh's Surface
            hands.button("OK")
            hands.button("Apply")
            hands.press(PANEL + "FoldResult")
            place = hands.find("button\tUse it")
            best = hands.text(PANEL + "BestMethod/BestMethod")
            hands.press_at(place)
            self.assertEqual(hands.wait(PANEL + "Method/ComboBox", best.__eq__), best)
            self.ended()
        self.task("then compare and take the best", compare)

    def test_deck(self):
        hands = self.hands
        part, copy = self.folder / "part.inp", self.folder / "copy.inp"
        deck(part, simple.OpenDataFile(str(CANISTER)))

        def morph():
            self.open(part)
            hands.button("Morph Mesh")
            hands.tick(ROWS, LID)
            hands.drag((0.6, 0.5), (0.62, 0.53))
            hands.button("Apply")
            self.ended()
            hands.button("actionSaveData")
            hands.find("widget\tFileSaveDialog")
            hands.type(str(copy), "Return")
            hands.find("button\tApply", enabled=False)  # the window is idle
        self.task("morph an .inp file", morph)
        before, after = (path.read_text(encoding="utf-8").splitlines() for path in (part, copy))
        nodes = before.index("*ELEMENT, TYPE=C3D8")
        self.assertEqual(before[nodes:], after[nodes:])
        changed = sum(a != b for a, b in zip(before[:nodes], after[:nodes], strict=True))
        self.assertGreater(changed, nodes // 2)

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


class Counts(unittest.TestCase):
    def test_all(self):
        self.assertEqual(len(COUNTS), 12)
        self.assertLessEqual(sum(COUNTS.values()), MOST_OF_ALL)


if __name__ == "__main__":
    unittest.main()
