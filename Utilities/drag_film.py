# SPDX-License-Identifier: BSD-3-Clause
"""Films a live drag in ParaView's window, by a real mouse: a GIF under 3 MB.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> \\
     MESHMORPHING_PANEL_ROWS=<path of its tests' library panel_rows> \\
         xvfb-run -a -s "-noreset -screen 0 1270x990x24" \\
         pvpython Utilities/drag_film.py [picture.gif]
Needs ImageMagick."""
import argparse
import math
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "Testing/ParaView"))
from window_hands import Hands  # noqa: E402  (needs the path above)

MESH = ROOT / "Data/Models/small/courier_hex_small.vtu"
PANEL = "propertiesDock/ProxyPanel/"
BOSS = "Surface 6", "Surface 7"  # its top, and the hole in it
MIDDLE = 2  # button
SIZE, COLORS, MOST_BYTES = "700x546", 48, 3_000_000
SECONDS, FRAMES = 20, 50


def way(part):
    """A loop that begins in the boss, in parts of the view."""
    angle = 2 * math.pi * part
    return 0.36 - 0.04 * math.sin(angle), 0.47 + 0.03 * math.sin(2 * angle)


class Film:
    def __init__(self, folder):
        self.folder = folder
        self.frames = []

    def take(self):
        self.frames.append(str(self.folder / f"{len(self.frames):03}.png"))
        subprocess.run(["import", "-window", "root", "-resize", SIZE, self.frames[-1]], check=True)

    def along(self, places):
        """The places, with a frame before each but the first."""
        for i, place in enumerate(places):
            if i:
                self.take()
            yield place

    def save(self, path):
        delay = round(100 * SECONDS / len(self.frames))
        subprocess.run(["convert", "-delay", str(delay), "-loop", "0", *self.frames, "+dither",
                        "-colors", str(COLORS), "-layers", "optimize", str(path)], check=True)
        if path.stat().st_size > MOST_BYTES:
            sys.exit(f"{path} has {path.stat().st_size} bytes, more than {MOST_BYTES}")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("picture", nargs="?", type=Path,
                        default=ROOT / "Documentation/images/live-drag.gif")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        hands = Hands(Path(name))
        try:
            hands.button("actionOpenData")
            hands.find("widget\tFileOpenDialog")
            hands.type(str(MESH), "Return")
            hands.button("Apply")
            hands.drag((0.4, 0.5), (0.5, 0.42))  # turns it
            hands.button("Morph Mesh")
            for surface in BOSS:
                hands.tick(PANEL + "SurfaceTable/Rows", surface)
            hands.press(PANEL + "LiveDrag/CheckBox")
            hands.button("Apply")  # a drag is live from then on
            hands.wait(PANEL + "Advice/Status", lambda text: text.startswith("Valid"))
            hands.choose("representationToolbar/comboBox", "Surface With Edges")
            film = Film(Path(name))
            path = [hands.view(way(i / FRAMES)) for i in range(FRAMES + 1)]
            hands.keyboard.drag(film.along(path), MIDDLE)
            film.save(arguments.picture)
        finally:
            hands.close()


if __name__ == "__main__":
    main()
