# SPDX-License-Identifier: BSD-3-Clause
"""File > Save Coordinates Into in ParaView's window: it asks for a solver's file and for the copy,
which gets the coordinates of the active data. ParaView's Save Data would write another file.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> xvfb-run -s "-screen 0 1280x1024x24"
         pvpython window_solver_files.py
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SHIFT = (0.05, 0.02, -0.03)


def scene():
    """In ParaView's window: the file by Solver File Reader and by ParaView's reader, the first one
    morphed. MORPH_SCENE: which of both is active."""
    from paraview import simple
    simple.LoadPlugin(os.environ["MESHMORPHING_PLUGIN"], remote=False, ns=globals())
    path = os.environ["MORPH_FILE"]
    if os.environ["MORPH_SCENE"] == "empty":
        return
    if os.environ["MORPH_SCENE"] == "displaced":
        active = simple.OpenDataFile(path)
        active.ApplyDisplacements = 1
    else:
        active = MorphMesh(Input=SolverFileReader(FileName=path), Moving="Everything",
                           Displacement="Vector", Vector=list(SHIFT))
    active.UpdatePipeline(0.0)
    simple.SetActiveSource(active)


@unittest.skipUnless(shutil.which("ncgen"), "ncgen is not installed (netcdf-bin)")
class SaveCoordinates(unittest.TestCase):
    def setUp(self):
        sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "Programs"))
        import exodus_models
        import solver_models as models
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.model, _ = models.random_model("paraview window")
        cdl, self.path = self.folder / "model.cdl", self.folder / "model.e"
        cdl.write_text(exodus_models.exodus(self.model))
        subprocess.run(["ncgen", "-o", self.path, cdl], check=True, timeout=60)

    def save(self, which):
        """Plays the menu and its two dialogs; returns ParaView's messages and the copy."""
        from window_events import MAIN, Events
        out = self.folder / "out.e"
        events = Events()
        events.menu("menu_File", "actionSaveCoordinatesInto")
        events.do(MAIN + "SolverFileDialog", "filesSelected", str(self.path))
        events.do(MAIN + "SaveCoordinatesDialog", "filesSelected", str(out))
        home = self.folder / "home"
        home.mkdir()
        code, messages = events.play(home, seconds=250, script=Path(__file__).resolve(),
                                     environment={"MORPH_SCENE": which,
                                                  "MORPH_FILE": str(self.path)})
        self.assertEqual(code, 0, messages)
        return messages, out

    def dump(self, path):
        """The text without coordinates, and these."""
        text = subprocess.run(["ncdump", "-p", "9,17", path], capture_output=True, text=True,
                              check=True, timeout=60).stdout
        axes = [list(map(float, re.search(rf"coord{a} =([^;]*);", text)[1].split(",")))
                for a in "xyz"]
        return re.sub(r"coord[xyz] =[^;]*;", "", text).partition("{")[2], axes

    def test_a_morph_into_a_copy(self):
        messages, out = self.save("morphed")
        self.assertTrue(out.exists(), messages)
        self.assertNotIn("ERR|", messages)
        rest, axes = self.dump(out)
        self.assertEqual(rest, self.dump(self.path)[0])
        for axis, shift in enumerate(SHIFT):
            for node, written in zip(self.model.order, axes[axis]):
                self.assertAlmostEqual(written, self.model.points[node][axis] + shift, delta=1e-14)

    def test_displacements_of_a_reader_become_coordinates(self):
        messages, out = self.save("displaced")
        self.assertTrue(out.exists(), messages)
        self.assertNotIn("ERR|", messages)
        axes = self.dump(out)[1]
        for axis, written in enumerate(axes):
            for i, node in enumerate(self.model.order):
                displacement = 1e-3 * (axis + 1) + 1e-5 * i
                self.assertAlmostEqual(written[i], self.model.points[node][axis] + displacement,
                                       delta=1e-14)


class Open(unittest.TestCase):
    def test_our_reader_takes_a_deck_of_abaqus(self):
        """ParaView has two readers of .inp, and would ask."""
        from window_events import MAIN, Events
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            path, state = folder / "part.inp", folder / "state.pvsm"
            path.write_text("*NODE\n1,0.,0.,0.\n2,1.,0.,0.\n3,0.,1.,0.\n4,0.,0.,1.\n"
                            "*ELEMENT, TYPE=C3D4\n1,1,2,3,4\n")
            events = Events()
            events.do(MAIN + "MainControlsToolbar/actionOpenData", "activate")
            events.do(MAIN + "FileOpenDialog", "filesSelected", str(path))
            events.save_state(state)
            home = folder / "home"
            home.mkdir()
            code, messages = events.play(home, seconds=250, script=Path(__file__).resolve(),
                                         environment={"MORPH_SCENE": "empty",
                                                      "MORPH_FILE": str(path)})
            self.assertEqual(code, 0, messages)
            found = re.search(r"group=.sources. type=.(\w+).", state.read_text())
            self.assertEqual(found and found[1], "SolverFileReader", messages)


if "MORPH_SCENE" in os.environ:
    scene()
elif __name__ == "__main__":
    sys.exit(unittest.main())
