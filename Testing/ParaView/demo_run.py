# SPDX-License-Identifier: BSD-3-Clause
"""Runs the demo as a user does, with three steps of time, and checks what it prints and writes."""

import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np
from paraview import simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersVerdict import vtkMeshQuality
from vtkmodules.vtkIOImage import vtkPNGReader
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "Data"))
import Models  # noqa: E402  (needs the path above)
from linear_elements import laplace_on_tetrahedra  # noqa: E402


def read(path):
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def points_of(grid):
    return vtk_to_numpy(grid.GetPoints().GetData())


def number(grid, name):
    return grid.GetFieldData().GetArray(name).GetValue(0)


def verdict(grid):
    quality = vtkMeshQuality()
    quality.SetTetQualityMeasureToScaledJacobian()
    quality.SetHexQualityMeasureToScaledJacobian()
    quality.SetInputData(grid)
    quality.Update()
    return vtk_to_numpy(quality.GetOutput().GetCellData().GetArray("Quality"))


def femwarp_minima(mesh):
    """Minimum scaled Jacobians of a ClassifiedMesh of tetrahedra at t = 0, 0.5 and 1."""
    rest = mesh.points[mesh.nodes]
    moves = np.hstack([mesh.boundary_positions(t) - rest for t in (0, 0.5, 1)])
    fields = laplace_on_tetrahedra(mesh.points, mesh.cells, mesh.nodes, moves)
    return [verdict(mesh.to_vtk(mesh.points + field)).min() for field in np.hsplit(fields, 3)]


class Demo(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.output = Path(cls.folder.name) / "made" / "here"
        cls.process = subprocess.run(
            ["xvfb-run", "-a", "-s", "-noreset -screen 0 1280x1024x24",
             "pvpython", "--force-offscreen-rendering", str(ROOT / "Utilities" / "demo.py"),
             "--plugin", os.environ["MESHMORPHING_PLUGIN"],
             "--output", str(cls.output), "--steps", "2"],
            capture_output=True, text=True, timeout=550)
        bore = Models.get("bore")
        cls.meshes = {"bore_hex": bore.hex_mesh(), "bore_tet": bore.tet_mesh()}
        # Minima at t = 0, 0.5 and 1, from independent implementations of FEMWARP on these meshes.
        # Each version of Gmsh makes other tetrahedra.
        cls.minima = {"bore_hex": (0.8016, 0.5380, 0.3461),
                      "bore_tet": femwarp_minima(cls.meshes["bore_tet"])}

    def test_runs_without_a_complaint(self):
        self.assertEqual(self.process.returncode, 0, self.process.stderr)
        self.assertEqual(self.process.stderr.strip(), "")
        self.assertIn(str(self.output), self.process.stdout)

    def test_the_hexahedra_are_those_of_the_stored_table(self):
        """In all printed digits, whatever the version of Debian: no generator makes these meshes.
        NumPy's last bits differ, though. Smoothing differs by little; the inversion-free search
        ends at one of several maxima (rounding.py)."""
        def rows(text):
            part = "".join(re.findall("Hexahedra(.*?)Tetrahedra", text, re.DOTALL))
            pattern = r"  ([A-Z][\w -]*\w) +(-?\d\.\d{4}) +(\d\.\d{4}) +(\d+)\b"
            return {name: tuple(map(float, numbers))
                    for name, *numbers in re.findall(pattern, part)}

        stored = (ROOT / "Testing/Benchmark/results/demo.txt").read_text(encoding="utf-8")
        expected, found = rows(stored), rows(self.process.stdout)
        self.assertEqual(len(expected), 8)
        self.assertEqual(set(found), set(expected))
        for method, numbers in expected.items():
            delta = {"Smoothing": 5e-4, "Inversion-free": 0.02}.get(method, 1e-9)
            for a, b in zip(numbers, found[method]):
                self.assertAlmostEqual(a, b, delta=delta, msg=method)

    def test_quality(self):
        for name, (initial, _, final) in self.minima.items():
            for state, minimum in (("before", initial), ("after", final)):
                with self.subTest(name=name, state=state):
                    grid = read(self.output / f"{name}_{state}.vtu")
                    self.assertAlmostEqual(number(grid, "MinScaledJacobian"), minimum, delta=2e-4)
                    self.assertEqual(number(grid, "InvertedCells"), 0)
                    measured = vtk_to_numpy(grid.GetCellData().GetArray("ScaledJacobian"))
                    self.assertLess(np.abs(measured - verdict(grid)).max(), 1e-12)
                    self.assertIn(f"{number(grid, 'MinScaledJacobian'):.4f}", self.process.stdout)

    def test_every_method_has_a_row(self):
        # Weighted residual's from an independent implementation on the same mesh.
        rows = [line.split() for line in self.process.stdout.splitlines()]
        for name, words, minimum in (("FEMWARP", 1, 0.3461), ("Weighted residual", 2, 0.26885),
                                     ("Simplex-linear", 1, None),
                                     ("Simplex-natural neighbor", 2, None),
                                     ("Smoothing", 1, None),
                                     ("Inversion-free", 1, 0.55)):
            with self.subTest(name=name):
                found = [row[words:] for row in rows if row[:words] == name.split()]
                self.assertEqual([len(row) for row in found], [5, 5, 5])  # two bores, and the plate
                for least, mean, inverted, prepare, evaluate in found:
                    self.assertLess(float(least), float(mean))
                    self.assertEqual(int(inverted) > 0, float(least) <= 0)
                    self.assertGreater(float(prepare), 0)
                    self.assertGreater(float(evaluate), 0)
                if name == "Inversion-free":
                    self.assertEqual([int(row[2]) for row in found], [0, 0, 0])
                    self.assertGreater(float(found[0][0]), minimum)
                elif minimum:
                    self.assertAlmostEqual(float(found[0][0]), minimum, delta=5e-4)
                else:
                    self.assertGreater(float(found[0][0]), 0.3)

    def test_positions(self):
        for name, mesh in self.meshes.items():
            with self.subTest(name=name):
                before = points_of(read(self.output / f"{name}_before.vtu"))
                after = points_of(read(self.output / f"{name}_after.vtu"))
                self.assertTrue(np.array_equal(after[mesh.nodes], mesh.boundary_positions(1)))
                self.assertTrue(np.array_equal(before, mesh.points))

    def test_the_plate_stays_plane_as_its_hole_grows(self):
        before, after = (read(self.output / f"plate_{state}.vtu") for state in ("before", "after"))
        self.assertEqual(number(after, "InvertedCells"), 0)
        rest, moved = points_of(before), points_of(after)
        radii = np.linalg.norm(moved, axis=1)
        self.assertAlmostEqual(radii.min(), 0.75, 12)
        self.assertEqual(np.abs(moved[:, 2]).max(), 0)
        self.assertTrue(np.array_equal(moved[-64:], rest[-64:]))
        # Nearly the harmonic motion of a ring between the hole and the outline's mean radius.
        ring = np.linalg.norm(rest, axis=1) < 0.8
        outer, growth = 2.2, radii - np.linalg.norm(rest, axis=1)
        b = 0.25 / (1 / 0.5 - 0.5 / outer**2)
        exact = b / np.linalg.norm(rest, axis=1) - b * np.linalg.norm(rest, axis=1) / outer**2
        self.assertLess(np.abs(growth - exact)[ring].max(), 0.01)

    def test_series_plays_in_paraview(self):
        for name, (_, halfway, _) in self.minima.items():
            with self.subTest(name=name):
                reader = simple.PVDReader(FileName=str(self.output / f"{name}.pvd"))
                self.assertEqual(list(reader.TimestepValues), [0.0, 0.5, 1.0])
                reader.UpdatePipeline(0.5)
                grid = reader.GetClientSideObject().GetOutputDataObject(0)
                self.assertAlmostEqual(number(grid, "MinScaledJacobian"), halfway, delta=2e-4)

    def test_picture(self):
        reader = vtkPNGReader()
        reader.SetFileName(str(self.output / "bore-femwarp.png"))
        reader.Update()
        image = reader.GetOutput()
        self.assertEqual(image.GetDimensions(), (1600, 860, 1))
        pixels = vtk_to_numpy(image.GetPointData().GetScalars()).astype(int)
        painted = np.count_nonzero(pixels.min(axis=1) < 250) / len(pixels)
        self.assertGreater(painted, 0.35)
        self.assertGreater(np.count_nonzero(np.ptp(pixels, axis=1) > 60) / len(pixels), 0.2)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
