# SPDX-License-Identifier: BSD-3-Clause
"""Twelve tasks of a first-time user in ParaView's window, by a real mouse and keyboard
(window_hands.py). Each is counted, and its result is that of pvpython where it can be.

A press and release, a drag, a value that is typed, and a key count one each. Some tasks go on with
the filter of the one before, as their names say.

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
MOST_OF_ONE, MOST_OF_ALL = 9, 60
PANEL = "propertiesDock/ProxyPanel/"
STATUS = PANEL + "Advice/Status"
ROWS = PANEL + "SurfaceTable/Rows"


def done(text):
    return text.startswith(("Valid", "Repaired"))


class TwelveTasks(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def start(self):
        try:
            self.hands = Hands(self.folder)
        except OSError as missing:
            self.skipTest(str(missing))
        self.addCleanup(self.hands.close)

    def open(self, path):
        """Not counted: the mesh is there."""
        hands = self.hands
        hands.button("actionOpenData")
        hands.find("widget\tFileOpenDialog")
        hands.type(str(path), "Return")
        hands.button("Apply")

    def test_all(self):
        self.start()
        self.open(CANISTER)
        hands = self.hands
        hands.count = 0
        hands.button("Morph Mesh")
        hands.tick(ROWS, "Surface 0")
        hands.choose(PANEL + "Displacement/ComboBox", "Radius")
        hands.fill(PANEL + "RadiusChange/DoubleLineEdit0", ".1")
        hands.button("Apply")
        print(hands.wait(STATUS, done), hands.count)
        picture("hole")


if __name__ == "__main__":
    unittest.main()
