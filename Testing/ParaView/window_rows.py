# SPDX-License-Identifier: BSD-3-Clause
"""The panels of the filters in ParaView's window: a dozen rows at most, and nothing cut off in a
dock of 340 pixels. The rest is below titles that open, and that say what they hold.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> MESHMORPHING_PANEL_ROWS=<path of its library>
         xvfb-run -s "-screen 0 1280x1024x24" pvpython window_rows.py
"""
import json
import os
import tempfile
import unittest
from pathlib import Path

from paraview import simple

from window_events import HERE, PANEL, Events

SMALL = HERE.parents[1] / "Data/Models/small"
MOST, DOCK = 12, 340
simple.LoadPlugin(os.environ["MESHMORPHING_PLUGIN"], remote=False, ns=globals())

#: With one input, and with a dialog for more.
ONE_INPUT = ("MorphMesh", "FitToSurface", "RepairMesh", "BoundaryDisplacement",
             "ScaledJacobian", "ClassifyBoundary", "ExtractMorphBoundary")
MORE_INPUTS = ("CompareMorphMethods", "MorphShapes", "MorphBoundary", "MorphAdjoint",
               "MorphFEMWARP", "MorphLBWARP", "MorphInversionFree", "MorphRadialBasis",
               "MorphSimplexLinear", "MorphSimplexNaturalNeighbor", "MorphSmoothing",
               "MorphWeightedResidual")


class Panels(unittest.TestCase):
    """Looks at the panel step by step."""
    mesh = "canister_hex_small.vtu"

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.events = Events()
        self.events.load_plugin(os.environ["MESHMORPHING_PLUGIN"])
        self.events.open(str(SMALL / self.mesh))

    def look(self, name):
        self.events.save_state(self.folder / f"{name}.pvsm")

    def play(self, dock=DOCK):
        """What the panel had at each look, in a dock of so many pixels."""
        (self.folder / "home").mkdir()
        code, messages = self.events.play(
            self.folder / "home", script=HERE / "window_panel.py", environment={
                "MORPH_ROWS": str(self.folder / "rows.jsonl"), "MORPH_DOCK": str(dock)})
        self.assertEqual(code, 0, messages)
        self.assertTrue((self.folder / "rows.jsonl").exists(), messages)
        lines = (self.folder / "rows.jsonl").read_text(encoding="utf-8").splitlines()
        return [json.loads(line) for line in lines]


class Rows(Panels):
    def test_a_dozen_rows_at_most(self):
        for name in ONE_INPUT + MORE_INPUTS:
            self.events.select("/0:0/0:0")
            self.events.filter(name)
            if name in MORE_INPUTS:
                self.events.accept_inputs()
            self.look(name)
        for name, panel in zip(ONE_INPUT + MORE_INPUTS, self.play(), strict=True):
            with self.subTest(filter=name):
                self.assertLessEqual(len(panel["rows"]), MOST, panel["rows"])
                self.assertEqual(panel["cut"], [], panel)
                self.assertLessEqual(panel["dock"], DOCK)
                self.assertNotIn("-1", panel["texts"])

    def test_a_new_window_is_wide_enough(self):
        self.events.filter("MorphMesh")
        self.look("MorphMesh")
        panel, = self.play(dock=0)
        self.assertEqual(panel["cut"], [], panel)
        self.assertIn("Role", panel["columns"])

    def test_the_lattice_begins_around_the_mesh(self):
        mesh = simple.OpenDataFile(str(SMALL / self.mesh))
        mesh.UpdatePipeline()
        morph = MorphMesh(Input=mesh, Displacement="Lattice", LatticeBox="Own")
        low, high = zip(*zip(*[iter(mesh.GetDataInformation().GetBounds())] * 2))
        self.assertEqual(list(low), [-1, -1, 0])
        self.assertEqual(list(morph.LatticePosition), list(low))
        for length, least, most in zip(morph.LatticeLength, low, high):
            self.assertAlmostEqual(length, most - least, delta=1e-12)

    def test_a_title_opens_its_group_and_says_what_it_holds(self):
        self.events.filter("MorphMesh")
        self.look("closed")
        self.events.set("FoldSteps", "activate", "")
        self.look("opened")
        self.events.set("NumberOfSteps/LineEdit0", "set_string", "5")
        self.events.set("KeepLayers/LineEdit0", "set_string", "1")
        self.look("filled")
        closed, opened, filled = self.play()
        for panel, of_steps, of_layers in ((closed, "", ""), (opened, "", ""),
                                           (filled, "5 steps", "1 layer")):
            self.assertEqual(panel["titles"]["FoldSteps"], of_steps)
            self.assertEqual(panel["titles"]["FoldZonesandlayers"], of_layers)
        self.assertEqual(set(opened["rows"]) - set(closed["rows"]),
                         {"ScaleFactor", "NumberOfSteps", "Stepping"})
        self.assertIn("KeepLayers", filled["rows"])  # a value opens its group


class Status(Panels):
    """The first line of the panel says how the morph ended, in a color."""
    mesh = "bore_hex_small.vtu"
    GREEN, ORANGE, RED = "#2e7d32", "#b35900", "#b71c1c"

    def test_valid_partial_inverted_failed(self):
        up = {"Surfaces": ["Surface 1"], "Displacement": "Vector", "Surroundings": "Stay"}
        morph = MorphMesh(Input=simple.OpenDataFile(str(SMALL / self.mesh)), **up)
        self.events.filter("MorphMesh")
        for command, buttons in (("mousePress", "1,1"), ("mouseRelease", "1,0")):
            self.events.set("SurfaceTable/Rows", command, f"{buttons},0,12,8,/1:0")
        self.events.set("Displacement/ComboBox", "set_string", "Vector")
        self.events.set("Surroundings/ComboBox", "set_string", "Stay")
        self.events.set("FoldResult", "activate", "")
        said = []
        for height, validity in ((0.1, "Repair"), (1.5, "Sub step"), (1.5, "Report")):
            morph.Vector, morph.Validity = [0, 0, height], validity
            morph.UpdatePipeline()
            said.append({"Valid": "Valid", "Partial": f"Reached {int(100 * morph.LargestValidStep)}"
                         " % of the motion", "Inverted": f"{morph.InvertedCells} inverted cells"}
                        [morph.MorphStatus] + f", minimum {morph.MinScaledJacobian:.3g}")
            self.events.set("Validity/ComboBox", "set_string", validity)
            self.events.set("Vector/DoubleLineEdit2", "set_string", str(height))
            self.events.apply()
            self.look(validity)
        self.events.set("Validity/Message0/Remedy0", "activate", "")
        self.events.expect(PANEL + "Validity/ComboBox", "Repair", "currentText")
        self.events.set("Displacement/ComboBox", "set_string", "Radius")
        self.events.set("RadiusChange/DoubleLineEdit0", "set_string", "-9")
        self.events.apply()  # more than there is
        self.look("Radius")
        morph.Displacement, morph.RadiusChange = "Radius", -9
        morph.UpdatePipeline()
        self.assertEqual((morph.LargestValidStep, morph.BoundaryMinimum), (-1, -1))  # not known
        said.append("Failed: the mesh is undeformed")
        colors = self.GREEN, self.ORANGE, self.RED, self.RED
        played = self.play()
        minima = [float(text.rsplit(" ", 1)[1]) for text in said[:3]]
        for panel, minimum in zip(played, minima):
            self.assertAlmostEqual(panel["bars"]["Minimum"], minimum, delta=0.005)
        self.assertNotIn("Minimum", played[3]["bars"])  # of what failed
        for name in ("LargestValidStep", "BoundaryMinimum", "MinScaledJacobian"):
            self.assertEqual([name in panel["rows"] for panel in played],
                             [True, True, name != "LargestValidStep", False], name)
        for panel, text, color in zip(played, said, colors, strict=True):
            self.assertIn(color, panel["styles"].get(text, ""), panel["texts"])


if __name__ == "__main__":
    unittest.main()
