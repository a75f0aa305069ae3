# SPDX-License-Identifier: BSD-3-Clause
"""Morph Mesh's table of surfaces in ParaView's window: ticks, roles for one row or several, the
search field, and rows that a selection in the view selects. A script reads the same lists.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> MESHMORPHING_PANEL_ROWS=<path of its library>
         xvfb-run -s "-screen 0 1280x1024x24" pvpython window_table.py
"""
import os
import unittest

from paraview import simple

import versions
from window_events import MAIN, PANEL, VIEW
from window_morph_mesh import BOX
from window_rows import Panels

simple.LoadPlugin(os.environ["MESHMORPHING_PLUGIN"], remote=False, ns=globals())

ROWS, ROLES = "SurfaceTable/Rows", PANEL + "SurfaceTable/Roles"
CONTROL = 0x04000000  # Qt::ControlModifier
SHAPE, ROLE = 3, 4  # columns


class Table(Panels):
    def press(self, row, column=0, x=40, keys=0, button=1):
        """In a row of the table, by default on its name."""
        for command, down in (("mousePress", button), ("mouseRelease", 0)):
            self.events.set(ROWS, command, f"{button},{down},{keys},{x},8,/{row}:{column}")

    def choose(self, row, role):
        """From the drop-down of a row."""
        self.press(row, ROLE)
        self.events.do(ROLES, "activate", role)

    def roles(self, panel):
        return {row[0]: row[ROLE] for row in panel["table"] if row[ROLE]}

    def loaded(self, look):
        """The filter, in this process."""
        simple.ResetSession()
        simple.LoadState(str(self.folder / f"{look}.pvsm"))
        return simple.FindSource("MorphMesh1")

    def test_roles(self):
        self.events.filter("MorphMesh")
        self.look("new")
        self.press(3, x=12)  # its box
        self.choose(1, "Slides")
        self.press(0)
        self.press(2, keys=CONTROL)
        self.choose(2, "Stays")
        self.look("chosen")
        self.events.apply()
        self.look("applied")
        script = self.folder / "roles.py"
        self.events.menu("menu_File", "actionFileSaveServerState")
        self.events.do(MAIN + "FileSaveServerStateDialog", "filesSelected", str(script))
        self.events.do("StateOptionsDialog/widget/OKButton", "activate")
        new, chosen, applied = self.play()
        self.assertEqual([row[0] for row in new["table"]],
                         [*(f"Surface {i}" for i in range(4)), "+ 4 curves"])
        self.assertEqual(set(self.roles(new).values()), {"Follows"})
        self.assertEqual(self.roles(chosen), {"Surface 0": "Stays", "Surface 1": "Slides",
                                              "Surface 2": "Stays", "Surface 3": "Moves"})
        self.assertEqual(self.roles(applied), self.roles(chosen))
        self.assertEqual(applied["table"][0][0], "Surface 3")  # what moves comes first
        morph = self.loaded("applied")
        self.assertEqual(list(morph.Surfaces), ["Surface 3"])
        self.assertEqual(list(morph.SlidingSurfaces), ["Surface 1"])
        self.assertEqual(list(morph.FixedSurfaces), ["Surface 0", "Surface 2"])
        self.assertEqual(len(morph.FreeSurfaces), 0)
        text = script.read_text(encoding="utf-8")
        self.assertIn(versions.traced("FixedSurfaces", "['Surface 0', 'Surface 2']"), text)
        self.assertIn(versions.traced("SlidingSurfaces", "['Surface 1']"), text)

    def test_a_wide_panel_shows_the_shapes(self):
        self.events.filter("MorphMesh")
        self.look("narrow")
        narrow, = self.play()
        self.assertEqual({row[0]: row[SHAPE] for row in narrow["table"] if row[ROLE]},
                         {"Surface 0": "R 0.25", "Surface 1": "R 1", "Surface 2": "plane",
                          "Surface 3": "plane"})
        self.assertNotIn("Shape", narrow["columns"])
        self.folder = self.folder / "wide"
        self.folder.mkdir()
        self.events.lines = [line.replace("narrow.pvsm", "wide/wide.pvsm")
                             for line in self.events.lines]
        wide, = self.play(dock=480)
        self.assertIn("Shape", wide["columns"])
        self.assertEqual(wide["cut"], [])

    def test_rows_are_found(self):
        self.events.filter("MorphMesh")
        self.events.set("SurfaceTable/Search", "set_string", "e 3")
        self.look("found")
        self.events.set("SurfaceTable/Search", "set_string", "")
        self.press(4)  # that of the curves
        self.look("curves")
        found, curves = self.play()
        self.assertEqual([row[0] for row in found["table"]], ["Surface 3", "Curve 3"])
        self.assertEqual([row[0] for row in curves["table"]][5:], [f"Curve {i}" for i in range(4)])

    def test_a_motion_is_shown_before_it_is_applied(self):
        """The lid is a ring of radius 1 at z = 2.2; its ghost has arrows to there."""
        self.events.filter("MorphMesh")
        self.press(3, x=12)  # its box
        self.look("ticked")
        self.events.set(BOX + "translateZ", "set_string", "0.5")
        self.look("box")
        self.events.set("Displacement/ComboBox", "set_string", "Vector")
        self.events.set("Vector/DoubleLineEdit0", "set_string", "0.25")
        self.look("vector")
        self.events.set("Displacement/ComboBox", "set_string", "Along normals")
        self.events.set("Distance/DoubleLineEdit0", "set_string", "-0.2")
        self.look("normals")
        self.events.apply()
        self.look("applied")
        self.events.set("Surroundings/ComboBox", "set_string", "Stay")
        self.look("no other motion")
        ticked, box, vector, normals, applied, other = self.play()
        for panel in (ticked, applied, other):
            self.assertEqual([one for one in panel["ghosts"] if one[0] <= one[1]], [])
        for panel, bounds in ((box, (-1, 1, -1, 1, 2.2, 2.7)),
                              (vector, (-1, 1.25, -1, 1, 2.2, 2.2)),
                              (normals, (-1, 1, -1, 1, 2, 2.2))):
            ghost, = panel["ghosts"]
            for got, wanted in zip(ghost, bounds):
                self.assertAlmostEqual(got, wanted, delta=0.05)  # heads of arrows have a width

    def test_no_ghost_stands_beside_a_live_drag(self):
        self.events.filter("MorphMesh")
        self.press(3, x=12)
        self.events.apply()
        self.events.set("Displacement/LiveDrag/CheckBox", "set_boolean", "true")
        self.events.set(BOX + "translateX", "set_string", "0.5")
        self.look("typed")
        self.events.do(VIEW, "mousePress", "(0.5,0.5,4,4,0)")
        for step in range(1, 9):
            self.events.do(VIEW, "mouseMove", f"({0.5 + 0.004 * step:.3f},0.5,0,4,0)")
        self.look("dragged")
        self.events.do(VIEW, "mouseRelease", "(0.532,0.5,4,0,0)")
        typed, dragged = ([one for one in panel["ghosts"] if one[0] <= one[1]]
                          for panel in self.play())
        self.assertEqual((len(typed), dragged), (1, []))
        self.assertGreater(self.loaded("dragged").Transform.Translate[0], 0.5)  # it follows

    def test_the_view_gives_a_surface_its_role(self):
        self.events.filter("MorphMesh")
        self.events.apply()
        for place, role in (((0.6, 0.5), "Slides"), ((0.05, 0.05), None)):
            self.events.press_in_view(place, button=2)
            if role:
                self.events.do("PipelineContextMenu", "activate", role)
        self.look("chosen")
        chosen, = self.play()
        self.assertEqual(self.roles(chosen), {
            "Surface 0": "Follows", "Surface 1": "Follows", "Surface 2": "Follows",
            "Surface 3": "Slides"})

    def test_a_selection_in_the_view_selects_rows(self):
        self.events.filter("MorphMesh")
        self.events.apply()
        self.events.select_cells((0.6, 0.5), (0.62, 0.52))  # of the end that is seen
        self.look("selected")
        self.events.set("SurfaceTable/AddSelected", "activate", "")
        self.look("added")
        self.events.select_cells((0.45, 0.35), (0.47, 0.37))  # now there is a box
        self.look("again")
        selected, added, again = self.play()
        chosen = [row[0] for row in selected["table"] if row[-1]]
        self.assertEqual(chosen, ["Surface 3"])
        self.assertEqual([row[0] for row in added["table"] if row[-2]], chosen)
        self.assertEqual([row[0] for row in added["table"] if row[-1]], [])
        self.assertIn("Moves: Surface 3", added["texts"])
        self.assertEqual([row[0] for row in again["table"] if row[-1]], chosen)
        for name in ("selected", "again"):  # no box took the mouse
            self.assertEqual(list(self.loaded(name).Transform.Translate), [0, 0, 0])


if __name__ == "__main__":
    unittest.main()
