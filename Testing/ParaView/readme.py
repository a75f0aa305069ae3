# SPDX-License-Identifier: BSD-3-Clause
"""README.md's pvpython example and its command line, run as a user would run them in the project's
folder; and Examples/move_a_part.py.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> pvpython readme.py
"""
import os
import re
import shlex
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy

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
            # In a folder that looks like the project's, so that nothing is written into that.
            os.symlink(README.parent / "Data", os.path.join(folder, "Data"))
            script = Path(folder, "wider.py")
            script.write_text(blocks[0].replace(patterns[0], str(PLUGIN)), encoding="utf-8")
            result = subprocess.run([shutil.which("pvpython"), str(script)], cwd=folder,
                                    capture_output=True, text=True, timeout=120)
            self.assertEqual((result.returncode, result.stderr), (0, ""), result.stdout)
            saved = simple.LegacyVTKReader(FileNames=[os.path.join(folder, "wider.vtk")])
            said = re.search(r"^It prints .*?: `(.*)\.\.\. 0`\.$",
                             README.read_text(encoding="utf-8"), re.MULTILINE)[1]
            self.assertRegex(result.stdout, rf"^{re.escape(said)}\d* 0\n$")
            tutorial = README.parent / "Documentation/Tutorial.md"
            self.assertIn(f"*Valid, minimum {float(result.stdout.split()[0]):.3f}*",
                          tutorial.read_text(encoding="utf-8"))
            self.check_radius(saved)

            command = re.search(r"^    build/paraview/(bin/morph-mesh.*)$",
                                README.read_text(encoding="utf-8"), re.MULTILINE)[1]
            program = lib.parent / shlex.split(command)[0]
            result = subprocess.run([program, *shlex.split(command)[1:]], cwd=folder,
                                    capture_output=True, text=True, timeout=120)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.check_radius(simple.XMLUnstructuredGridReader(
                FileName=[os.path.join(folder, "wider.vtu")]))

    def check_radius(self, moved):
        """The hole's radius has grown by 0.1, and the outer one has not."""
        rest = simple.XMLUnstructuredGridReader(
            FileName=[str(README.parent / "Data/Models/small/canister_hex_small.vtu")])
        radii = []
        for mesh in (rest, moved):
            mesh.UpdatePipeline()
            points = vtk_to_numpy(servermanager.Fetch(mesh).GetPoints().GetData())
            radius = (points[:, 0] ** 2 + points[:, 1] ** 2) ** 0.5
            radii.append((radius.min(), radius.max()))
        self.assertAlmostEqual(radii[1][0], radii[0][0] + 0.1, delta=1e-6)
        self.assertAlmostEqual(radii[1][1], radii[0][1], delta=1e-6)

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

    def test_the_example_as_a_macro_with_nothing_selected(self):
        environment = {**os.environ, "PV_PLUGIN_PATH": str(PLUGIN.parents[1])}
        example = README.parent / "Examples/move_a_part.py"
        result = subprocess.run([shutil.which("pvpython"), str(example)], env=environment,
                                capture_output=True, text=True, timeout=120)
        self.assertEqual(result.returncode, 1)
        self.assertIn("RuntimeError: Select a volume mesh", result.stderr)


if __name__ == "__main__":
    unittest.main()
