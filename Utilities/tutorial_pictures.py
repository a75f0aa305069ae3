# SPDX-License-Identifier: BSD-3-Clause
"""Plays Documentation/Tutorial.md in ParaView's window and takes its pictures.

    xvfb-run -a -s "-noreset -screen 0 1280x1024x24" \\
        pvpython Utilities/tutorial_pictures.py [--plugin MeshMorphing.so] [folder]

Writes tutorial-surfaces.png and tutorial-result.png into Documentation/images, or the folder
given. Needs the plugin and ImageMagick."""
import argparse
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "Testing/ParaView"), str(ROOT / "Utilities")]
from built_plugin import BUILT  # noqa: E402  (needs the path above)
from window_events import MAIN, Events  # noqa: E402

MESH = ROOT / "Data/Models/small/canister_hex_small.vtu"
WIDTH, HEIGHT = 1150, 800
COLORS = 128  # of a picture


class Tutorial(Events):
    """The steps of the page."""

    def __init__(self, plugin):
        super().__init__()
        self.load_plugin(plugin)
        self.open(str(MESH))
        self.do(MAIN + "cameraToolbar/actionIsometricView", "activate")

    def tick(self, row):
        """In the table of surfaces."""
        for command, buttons in (("mousePress", "1,1"), ("mouseRelease", "1,0")):
            self.set("SurfaceTable/Rows", command, f"{buttons},0,12,8,/{row}:0")

    def show_the_surfaces(self):
        self.filter("MorphMesh")
        self.apply()

    def widen_the_hole(self):
        self.filter("MorphMesh")
        self.tick(0)
        self.set("Displacement/ComboBox", "set_string", "Radius")
        self.set("RadiusChange/DoubleLineEdit0", "set_string", "0.1")
        self.apply()


def picture(events, path):
    """Plays the events, and takes the window when they have been played."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        done = folder / "done.pvsm"
        events.menu("menu_File", "actionFileSaveServerState")
        events.do(MAIN + "FileSaveServerStateDialog", "filesSelected", str(done))
        how = events.prepare(folder, f"{WIDTH} {HEIGHT}")
        log = open(folder / "log.txt", "w+", encoding="utf-8")  # a pipe would fill
        window = subprocess.Popen(**{**how, "stdout": log})
        try:
            for _ in range(300):
                if done.exists() or window.poll() is not None:
                    break
                time.sleep(1)
            time.sleep(4)
            if not done.exists():
                log.seek(0)
                sys.exit(log.read())
            subprocess.run(["import", "-window", "root", "-crop", f"{WIDTH}x{HEIGHT}+0+0",
                            "+repage", "+dither", "-colors", str(COLORS), "-strip",
                            f"PNG8:{path}"], check=True)
        finally:
            window.terminate()
            window.wait()


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--plugin", default=min(BUILT.glob("**/MeshMorphing.so"), default=""))
    parser.add_argument("--only", default="", help="the name of one picture: surfaces, result")
    parser.add_argument("folder", nargs="?", default=ROOT / "Documentation/images", type=Path)
    arguments = parser.parse_args()
    for name, steps in (("surfaces", Tutorial.show_the_surfaces),
                        ("result", Tutorial.widen_the_hole)):
        if arguments.only in ("", name):
            events = Tutorial(str(arguments.plugin))
            steps(events)
            picture(events, arguments.folder / f"tutorial-{name}.png")


if __name__ == "__main__":
    main()
