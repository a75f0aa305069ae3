# SPDX-License-Identifier: BSD-3-Clause
"""ParaView's quick launch: Ctrl+Space, "morph", Enter makes Morph Mesh, its first hit.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> xvfb-run -s "-screen 0 1280x1024x24"
         pvpython window_quick_launch.py
"""
import os
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

MESH = "Data/Models/small/bore_hex_small.vtu"


def watch():
    """In ParaView's window: writes the names of the pipeline's sources whenever there is a new
    one."""
    from paraview import servermanager, simple
    if "PV_PLUGIN_PATH" not in os.environ:
        simple.LoadPlugin(os.environ["MESHMORPHING_PLUGIN"], remote=False, ns=globals())
    simple.Show(simple.OpenDataFile(str(Path(os.environ["MORPH_SOURCE"]) / MESH)))
    simple.ResetCamera()
    manager = servermanager.ProxyManager()

    def write(*_):
        names = [name for name, _ in manager.GetProxiesInGroup("sources")]
        Path(os.environ["MORPH_SEEN"]).write_text("\n".join(names), encoding="utf-8")
    manager.SMProxyManager.AddObserver("RegisterEvent", write)
    write()


class QuickLaunch(unittest.TestCase):
    def test_of_a_plugin_that_is_loaded_in_the_window(self):
        self.expect_morph_mesh_first({})

    def test_of_a_plugin_that_is_loaded_at_the_start(self):
        folder = Path(os.environ["MESHMORPHING_PLUGIN"]).parents[1]
        self.expect_morph_mesh_first({"PV_PLUGIN_PATH": str(folder)})

    def expect_morph_mesh_first(self, environment):
        from window_events import Events, picture
        from window_keys import Keyboard
        try:
            keyboard = Keyboard()
        except OSError as missing:
            self.skipTest(str(missing))
        script = Path(__file__).resolve()
        with tempfile.TemporaryDirectory() as name:
            seen = Path(name) / "seen.txt"
            how = Events().prepare(Path(name), script=script, environment={
                "MORPH_SOURCE": str(script.parents[2]), "MORPH_SEEN": str(seen)})
            how["stdout"] = subprocess.DEVNULL
            how["env"].update(environment)
            with subprocess.Popen(how.pop("args"), **how) as paraview:
                try:
                    self.assertIn("Reader", self.wait(seen, "Reader", 150))
                    for _ in range(6):
                        launch(keyboard, picture)
                        if "Morph" in self.wait(seen, "Morph", 15):
                            break
                    self.assertIn("MorphMesh1", seen.read_text(encoding="utf-8").split("\n"))
                    time.sleep(1)
                    picture("its first hit")
                finally:
                    paraview.kill()

    @staticmethod
    def wait(seen, word, seconds):
        """What is seen once that has `word`, or at the end."""
        text = ""
        for _ in range(2 * seconds):
            text = seen.read_text(encoding="utf-8") if seen.exists() else ""
            if word in text:
                break
            time.sleep(0.5)
        return text


def launch(keyboard, picture):
    """The window may not be there yet on a busy machine: then the keys have no effect."""
    keyboard.press("Escape")
    keyboard.click(500, 450)
    keyboard.press("Control_L", "space")
    time.sleep(2)
    for key in ("m", "o", "r", "p", "h"):
        keyboard.press(key)
    picture("what is found")
    keyboard.press("Return")


if "MORPH_SEEN" in os.environ:
    watch()
elif __name__ == "__main__":
    sys.exit(unittest.main())
