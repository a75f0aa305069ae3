# SPDX-License-Identifier: BSD-3-Clause
"""README.md's pvpython example, run as a user would run it, in a folder that holds part.vtu; and
Examples/move_a_part.py.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> pvpython readme.py
"""
import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

from paraview import simple

README = Path(__file__).resolve().parents[2] / "README.md"
PLUGIN = Path(os.environ["MESHMORPHING_PLUGIN"])


class Readme(unittest.TestCase):
    def test_pvpython_example(self):
        blocks = re.findall(r"^```python\n(.*?)^```", README.read_text(encoding="utf-8"),
                            re.MULTILINE | re.DOTALL)
        self.assertEqual(len(blocks), 1)
        patterns = re.findall(r'glob\("(.*?)"', blocks[0])
        self.assertEqual(len(patterns), 1)
        # From the folder lib on, which the built plugin is in.
        pattern = patterns[0].partition("/lib/")[2]
        lib = next(folder for folder in PLUGIN.parents if folder.name == "lib")
        self.assertIn(PLUGIN, lib.glob(pattern))

        with tempfile.TemporaryDirectory() as folder:
            part = simple.AppendDatasets(Input=[simple.Wavelet(WholeExtent=[0, 6, 0, 6, 0, 6])])
            # Appended data, the default, cannot be read back with Debian's expat.
            simple.SaveData(os.path.join(folder, "part.vtu"), proxy=part, DataMode="Binary")
            script = Path(folder, "example.py")
            script.write_text(blocks[0].replace(patterns[0], str(PLUGIN)), encoding="utf-8")
            result = subprocess.run([shutil.which("pvpython"), str(script)], cwd=folder,
                                    capture_output=True, text=True, timeout=120)
            self.assertEqual((result.returncode, result.stderr), (0, ""), result.stdout)
            saved = simple.LegacyVTKReader(FileNames=[os.path.join(folder, "part-moved.vtk")])
            saved.UpdatePipeline()
            information = saved.GetDataInformation()

        # Cubes that are stretched along z have right angles.
        minimum, inverted = map(float, result.stdout.split())
        self.assertAlmostEqual(minimum, 1, delta=1e-6)
        self.assertEqual(inverted, 0)
        self.assertEqual(information.GetNumberOfCells(), 6 ** 3)
        for bound, expected in zip(information.GetBounds(), (0, 6, 0, 6, 0, 6.5)):
            self.assertAlmostEqual(bound, expected, delta=1e-5)

    def test_example_script(self):
        mesh = README.parent / "Data/Models/small/bore_hex_small.vtu"
        with tempfile.TemporaryDirectory() as folder:
            target = os.path.join(folder, "moved.vtu")
            # ParaView loads the plugins that it finds there.
            environment = {**os.environ, "PV_PLUGIN_PATH": str(PLUGIN.parents[1])}
            example = README.parent / "Examples/move_a_part.py"
            result = subprocess.run([shutil.which("pvpython"), str(example), str(mesh), target],
                                    env=environment, capture_output=True, text=True, timeout=120)
            self.assertEqual((result.returncode, result.stderr), (0, ""), result.stdout)
            rest = simple.XMLUnstructuredGridReader(FileName=[str(mesh)])
            moved = simple.XMLUnstructuredGridReader(FileName=[target])
            for reader in (rest, moved):
                reader.UpdatePipeline()
            after, undeformed = moved.GetDataInformation(), rest.GetDataInformation()
            bounds, before = after.GetBounds(), undeformed.GetBounds()
            self.assertEqual(after.GetNumberOfCells(), undeformed.GetNumberOfCells())
        height = before[5] - before[4]
        self.assertAlmostEqual(bounds[4], before[4], delta=1e-6)
        self.assertAlmostEqual(bounds[5], before[5] + 0.05 * height, delta=1e-5)
        minimum, inverted = re.match(r"minimum scaled Jacobian (\S+), inverted cells (\d+)",
                                     result.stdout).groups()
        self.assertGreater(float(minimum), 0.5)
        self.assertEqual(inverted, "0")


if __name__ == "__main__":
    unittest.main()
