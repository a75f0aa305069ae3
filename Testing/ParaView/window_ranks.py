# SPDX-License-Identifier: BSD-3-Clause
"""ParaView's window on pvserver with two MPI ranks: Morph Mesh of a mesh in two pieces, whose
surfaces have the names and whose result has the numbers of one rank; a drag of the box.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> xvfb-run -s "-screen 0 1280x1024x24"
         pvpython window_ranks.py
"""
import os
import tempfile
import unittest
from pathlib import Path
from xml.etree import ElementTree

from paraview import simple
from vtkmodules.vtkCommonDataModel import VTK_HEXAHEDRON

import ranks
from distributed import grid_of, model, write, write_pieces
from versions import BOX_FIELDS
from window_events import PANEL, VIEW, Events, field, rows

PLUGIN = os.environ["MESHMORPHING_PLUGIN"]
simple.LoadPlugin(PLUGIN, remote=False, ns=globals())

SURFACE, UP = "Surface 2", "0.1"
#: Whole numbers: another solver gives the others to its tolerance alone.
NUMBERS = ("InvertedCells", "DegenerateCells", "WorstCellId", "PrescribedPoints")
BOX = f"Transform/ProxySelectionWidget/frame/ChosenProxyWidget/InteractiveBox/{BOX_FIELDS}"


class WindowOnRanks(unittest.TestCase):
    def test_morph_and_drag(self):
        points, cells = model(VTK_HEXAHEDRON, (8, 6, 5), 1)
        owner = (points[cells].mean(1)[:, 1] > points[:, 1].mean()).astype(int)
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            whole = str(folder / "whole.vtu")
            write(grid_of(points, cells, VTK_HEXAHEDRON), whole)
            serial = MorphMesh(Input=simple.OpenDataFile(whole), Surfaces=[SURFACE])
            serial.Transform.Translate = [0, 0, float(UP)]
            serial.UpdatePipeline()
            self.assertEqual(serial.MorphStatus, "Valid")
            names = rows(serial.GetProperty("Surfaces").GetAvailable())
            path = write_pieces(
                str(folder), "pieces", points, cells, VTK_HEXAHEDRON, owner, 2, True)

            server, port = ranks.start_server(ranks.command(2, "pvserver"))
            self.addCleanup(server.wait, 60)
            self.addCleanup(server.terminate)
            events = Events()
            events.load_plugin(PLUGIN)
            events.load_plugin(PLUGIN, "Remote")
            events.open(path)
            events.filter("MorphMesh")
            events.apply()  # lists the surfaces
            for command, buttons in (("mousePress", "1,1"), ("mouseRelease", "1,0")):
                events.set("SurfaceTable/Rows", command,
                           f"{buttons},0,12,8,/{names.index(SURFACE)}:0")
            events.set(BOX + "translateZ", "set_string", UP)
            events.apply()
            for number in NUMBERS:
                value = getattr(serial, number)
                events.expect(field(number, value), f"{value:.0f}")
            # The middle button drags the box as a whole; the mesh follows while it is dragged.
            events.do(VIEW, "mousePress", "(0.5,0.5,4,4,0)")
            for step in range(1, 5):
                place = f"({0.5 + 0.004 * step:.4f},{0.5 + 0.003 * step:.4f}"
                events.do(VIEW, "mouseMove", place + ",0,4,0)")
            events.do(VIEW, "mouseRelease", place + ",4,0,0)")
            events.apply()
            events.expect(f"{PANEL}InvertedCells/Number", "0")
            state = folder / "dragged.pvsm"
            events.save_state(state)
            home = folder / "home"
            home.mkdir()
            code, messages = events.play(home, seconds=200,
                                         arguments=[f"--server-url=cs://localhost:{port}"])
            self.assertEqual(code, 0, messages)
            self.assertNotIn("ERR|", messages)
            translate = ElementTree.parse(state).find(
                ".//Proxy[@type='Transform3']/Property[@name='Position']")
            moved = [float(element.get("value")) for element in translate.iter("Element")
                     if element.get("index")][:3]
            self.assertGreater(max(abs(a - b) for a, b in zip(moved, (0, 0, float(UP)))), 1e-3)


if __name__ == "__main__":
    unittest.main()
