# SPDX-License-Identifier: BSD-3-Clause
"""Twelve tasks of a first-time user in ParaView's window, by a real mouse and keyboard
(window_hands.py). Each is counted, and its result is that of pvpython where numbers are typed.

A press and release, a drag, a value that is typed, and a key count one each. A task that begins
with "then" goes on with the filter of the one before.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> MESHMORPHING_PANEL_ROWS=<path of its library>
         xvfb-run -s "-screen 0 1280x1024x24" pvpython window_twelve_tasks.py
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
CANISTER, COURIER = SMALL / "canister_hex_small.vtu", SMALL / "courier_hex_small.vtu"
HOLE, LID = "Surface 0", "Surface 3"
#: Of each task, in the order of the tutorial's table.
COUNTS = {"enlarge a hole": 7, "move a boss that is selected in the view": 6,
          "bend by the box": 4, "then drag live": 2, "fit to an STL file": 2,
          "then keep layers": 4, "then freeze a zone": 2, "two shapes with sliders": 9,
          "then 20 steps, and play": 5, "compare the methods, and take the best": 7,
          "repair a tangled mesh": 2, "open an .inp file, morph it, save it back": 9}
MOST_OF_ONE, MOST_OF_ALL = 9, 60
PANEL = "propertiesDock/ProxyPanel/"
STATUS, ROWS = PANEL + "Advice/Status", PANEL + "SurfaceTable/Rows"
MIDDLE = 2  # button
TANGLED = ("coords + 0.3*sin(coordsZ*3.14159/2.2)*sin((sqrt(coordsX^2 + coordsY^2) - 0.25)*3.14159/"
           "0.75)*sin(19*coordsX)*sin(23*coordsY)*(iHat + jHat + kHat)")
#: A block of 4 x 4 x 2 hexahedra with its top as a set of nodes.
SIZE = (4, 4, 2)


def done(text):
    return text.startswith(("Valid", "Repaired"))


def status(morph):
    """What the first line of the panel says."""
    morph.UpdatePipeline()
    return f"{morph.MorphStatus}, minimum {morph.MinScaledJacobian:.3g}"


def deck():
    """Of Abaqus."""
    def node(i, j, k):
        return 1 + i + (SIZE[0] + 1) * (j + (SIZE[1] + 1) * k)

    def cells():
        return ((i, j, k) for k in range(SIZE[2]) for j in range(SIZE[1]) for i in range(SIZE[0]))
    lines = ["*NODE"]
    lines += [f"{node(i, j, k)}, {i}., {j}., {k}." for k in range(SIZE[2] + 1)
              for j in range(SIZE[1] + 1) for i in range(SIZE[0] + 1)]
    lines += ["*ELEMENT, TYPE=C3D8, ELSET=ALL"]
    for e, (i, j, k) in enumerate(cells(), 1):
        corners = [node(i + a, j + b, k + c) for c in (0, 1)
                   for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
        lines.append(", ".join(map(str, [e, *corners])))
    lines += ["*NSET, NSET=TOP"]
    lines += [f"{node(i, j, SIZE[2])}," for j in range(SIZE[1] + 1) for i in range(SIZE[0] + 1)]
    return "\n".join(lines) + "\n"


class TwelveTasks(unittest.TestCase):
    counted = {}

    @classmethod
    def tearDownClass(cls):
        if len(cls.counted) == len(COUNTS):
            assert sum(cls.counted.values()) <= MOST_OF_ALL, cls.counted

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
        self.counted[name] = self.hands.count
        picture(name)
        self.assertEqual(self.hands.count, COUNTS[name], name)
        self.assertLessEqual(self.hands.count, MOST_OF_ONE)

    def ended(self, accept=done):
        return self.hands.wait(STATUS, accept)

    def test_hole_and_comparison(self):
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
        wider.RadiusChange = 0.5  # of 0.75 that there are
        hands.fill(PANEL + "RadiusChange/DoubleLineEdit0", "0.5")
        hands.button("Apply")
        self.assertEqual(self.ended(lambda text: text == status(wider)), status(wider))
        self.assertTrue(done(status(wider)))
        wider.RadiusChange = 0.1
        best = CompareMorphMethods(Input=mesh, Boundary=simple.OutputPort(wider, 2))
        best.UpdatePipeline()

        def compare():
            hands.browser_row(1)
            hands.button("Compare Morph Methods")
            hands.press("SelectInputDialog/Boundary")
            hands.browser_row(5, "SelectInputDialog/pipelineView")
            hands.button("OK")
            hands.button("Apply")
            hands.button("Use it")
            hands.wait(PANEL + "Method/ComboBox", lambda text: text != "FEMWARP")
        hands.fill(PANEL + "RadiusChange/DoubleLineEdit0", "0.1")
        hands.button("Apply")
        self.ended(lambda text: text == status(wider))
        self.task("compare the methods, and take the best", compare)
        self.assertEqual(hands.text(PANEL + "Method/ComboBox"), best.BestMethod)

    def test_boss(self):
        hands = self.hands
        self.open(COURIER)

        def move():
            hands.button("Morph Mesh")
            hands.button("actionSelectSurfaceCells")
            hands.drag((0.45, 0.45), (0.55, 0.55))
            hands.button("Add selected surfaces")
            hands.drag((0.5, 0.5), (0.53, 0.52), MIDDLE)
            hands.button("Apply")
            self.ended()
        self.task("move a boss that is selected in the view", move)

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

    def test_shapes_and_steps(self):
        hands = self.hands
        self.open(CANISTER)

        def shapes():
            hands.button("Morph Mesh")
            hands.tick(ROWS, LID)
            hands.drag((0.5, 0.5), (0.52, 0.5), MIDDLE)
            hands.button("Save as Shape")
            hands.find(f"widget\t{PANEL}Weights/Slider0")
            hands.browser_row(2)
            hands.drag((0.52, 0.5), (0.52, 0.52), MIDDLE)
            hands.button("Save as Shape")
            for row in (0, 1):
                place = hands.find(f"widget\t{PANEL}Weights/Slider{row}")
                y = place["y"] + place["height"] / 2
                hands.keyboard.drag([(place["x"] + place["width"] * (0.5 + 0.05 * i), y)
                                     for i in range(4)])
                hands.count += 1
                hands.wait(f"{PANEL}Weights/Weight{row}", lambda text: float(text) > 0.1)
            self.ended()
        self.task("two shapes with sliders", shapes)
        hands.browser_row(2)

        def plays():
            hands.press(PANEL + "FoldSteps")
            hands.fill(PANEL + "NumberOfSteps/LineEdit0", "20")
            hands.button("Apply")
            hands.button("actionVCRPlay")
            hands.wait("AnimationTime", lambda text: text == "1")
            self.ended()
        self.task("then 20 steps, and play", plays)
        self.assertNotIn("WARN|", hands.messages())

    def test_inp(self):
        hands = self.hands
        part, copy = self.folder / "part.inp", self.folder / "copy.inp"
        part.write_text(deck(), encoding="utf-8")

        def there_and_back():
            hands.button("actionOpenData")
            hands.find("widget\tFileOpenDialog")
            hands.type(str(part), "Return")
            hands.button("Apply")
            hands.button("Morph Mesh")
            hands.tick(ROWS, "TOP")
            hands.drag((0.5, 0.5), (0.53, 0.52), MIDDLE)
            hands.button("Apply")
            self.ended()
            hands.key("Control_L", "s")
            hands.find("widget\tFileSaveDialog", enabled=False)
            hands.type(str(copy), "Return")
        self.task("open an .inp file, morph it, save it back", there_and_back)
        hands.find("button\tMorph Mesh")  # it is written
        before, after = (path.read_text(encoding="utf-8").splitlines() for path in (part, copy))
        changed = [i for i, lines in enumerate(zip(before, after, strict=True))
                   if lines[0] != lines[1]]
        self.assertGreater(len(changed), 10)
        self.assertLess(max(changed), before.index("*ELEMENT, TYPE=C3D8, ELSET=ALL"))


if __name__ == "__main__":
    unittest.main()
