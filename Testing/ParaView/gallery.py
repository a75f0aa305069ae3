# SPDX-License-Identifier: BSD-3-Clause
"""The scripts of Examples/gallery, on meshes of half their resolution: what is prescribed is
reached, no cell is inverted, and the mesh is still that of before. One of them makes its picture.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> pvpython gallery.py
"""
import csv
import importlib
import inspect
import os
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "Examples/gallery"), str(ROOT / "Utilities")]
from built_plugin import load_plugin  # noqa: E402  (needs the path above)

NAMES = sorted(path.stem for path in (ROOT / "Examples/gallery").glob("*.py")
               if path.stem != "gallery")


def small(name):
    """The example at half its resolution, where it has one."""
    make = importlib.import_module(name).example
    return make(*[each.default // 2 for each in inspect.signature(make).parameters.values()])


def connectivity(source):
    return vtk_to_numpy(servermanager.Fetch(source).GetCells().GetConnectivityArray())


class Gallery(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        load_plugin(os.environ["MESHMORPHING_PLUGIN"])

    def check(self, name):
        example = small(name)
        size = max(np.ptp(np.reshape(example.before.GetDataInformation().GetBounds(), (3, 2)),
                          axis=1))
        row = example.row()
        self.assertIn(row["status"], ("Valid", "Repaired"))
        self.assertEqual((row["inverted_before"], row["inverted_after"]), (0, 0))
        self.assertGreater(row["minimum_after"], 0)
        self.assertLess(row["miss"], 1e-6 * size)
        moved = importlib.import_module("gallery").points_of
        farthest = abs(moved(example.after) - moved(example.before)).max()
        self.assertGreater(farthest, 0.02 * size)
        np.testing.assert_array_equal(connectivity(example.after), connectivity(example.before))

    def test_picture_shows_red_cells_where_they_are_bad(self):
        """A cube whose upper face is pushed into its lower one: the plugin's color below 0."""
        gallery = importlib.import_module("gallery")
        points, cells = gallery.block(1, 1, 1)
        cube = gallery.mesh(points, gallery.hexahedra(cells))
        bad = gallery.mesh(points * [1, 1, -1], gallery.hexahedra(cells))
        with tempfile.TemporaryDirectory() as folder:
            path = f"{folder}/cubes.png"
            gallery.picture(path, "Cubes", [("before", cube), ("after", bad)])
            reader = vtkPNGReader()
            reader.SetFileName(path)
            reader.Update()
        width, height, _ = reader.GetOutput().GetDimensions()
        pixels = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars())
        pixels = pixels.reshape(height, width, -1)[height // 3:2 * height // 3].astype(int)
        left, right = pixels[:, width // 8:3 * width // 8], pixels[:, 5 * width // 8:7 * width // 8]
        self.assertGreater(np.median(left[..., 2] - left[..., 0]), 50)  # blue: 1
        self.assertLess(np.median(right[..., 1]), 30)  # no green: -1
        self.assertGreater(np.median(right[..., 0]), 50)

    def test_figures_are_of_all_scripts(self):
        with open(ROOT / "Documentation/Study/gallery.csv", encoding="utf-8") as file:
            self.assertEqual([row["script"] for row in csv.DictReader(file)], NAMES)
        page = (ROOT / "Documentation/Gallery.md").read_text(encoding="utf-8")
        for name in NAMES:
            self.assertIn(f"(images/gallery-{name}.png)", page)
            self.assertIn(f"(../Examples/gallery/{name}.py)", page)
            self.assertLess((ROOT / f"Documentation/images/gallery-{name}.png").stat().st_size,
                            150_000)


for script in NAMES:
    setattr(Gallery, f"test_{script}", lambda self, name=script: self.check(name))

if __name__ == "__main__":
    unittest.main()
