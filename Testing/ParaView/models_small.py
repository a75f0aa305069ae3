# SPDX-License-Identifier: BSD-3-Clause
"""The small meshes of the four models, those that the generators make and those on disk. Needs
pvpython and Gmsh, not the plugin."""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np
from paraview import simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

from model_checks import MeshChecks, Models

ROOT = Path(__file__).resolve().parents[2]


class SmallChecks(MeshChecks):
    structured = False

    def mesh_beyond(self):
        # The same whichever version of Gmsh is there.
        return self.geometry.read_small(self.kind)

    def test_file_on_disk(self):
        path = self.geometry.small_file(self.kind)
        self.assertLess(path.stat().st_size, 1_000_000)
        stored = self.geometry.read_small(self.kind)
        if self.structured:
            self.assertTrue(np.array_equal(stored.cells, self.mesh.cells))
            self.assertLess(np.abs(stored.points - self.mesh.points).max(), 1e-13 * self.size)
        else:
            # Another build of Gmsh may make a slightly different mesh.
            self.assertLess(abs(len(stored.points) / len(self.mesh.points) - 1), 0.05)
            self.assertLess(abs(len(stored.cells) / len(self.mesh.cells) - 1), 0.05)

    def test_arrays_on_disk(self):
        stored = self.geometry.read_small(self.kind)
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(self.geometry.small_file(self.kind)))
        reader.Update()
        data = reader.GetOutput().GetPointData()
        for name, expected in (
            ("GeometryDimension", stored.geometry_dimension),
            ("GeometryId", stored.geometry_id),
        ):
            values = vtk_to_numpy(data.GetArray(name))
            self.assertEqual(values.dtype, expected.dtype, name)
            self.assertTrue(np.array_equal(values, expected), name)
        parameter = vtk_to_numpy(data.GetArray("CurveParameter"))
        self.assertLess(np.abs(parameter - stored.curve_parameter).max(), 1e-12)
        move = vtk_to_numpy(data.GetArray("FinalDisplacement"))
        self.assertLess(np.abs(stored.moved(1) - stored.points - move).max(), 1e-12 * self.size)


class BoreHex(SmallChecks, unittest.TestCase):
    model, kind, structured = "bore", "hex", True


class BoreTet(SmallChecks, unittest.TestCase):
    model, kind = "bore", "tet"


class PipeHex(SmallChecks, unittest.TestCase):
    model, kind, structured = "pipe", "hex", True


class PipeTet(SmallChecks, unittest.TestCase):
    model, kind = "pipe", "tet"


class CanisterHex(SmallChecks, unittest.TestCase):
    model, kind, structured = "canister", "hex", True

    def test_rim_and_height_stay(self):
        rest, final = self.mesh.points, self.mesh.moved(1)
        rim = self.mesh.nodes[self.mesh.places[:, 0] == 1]
        self.assertTrue(np.array_equal(final[rim], rest[rim]))
        self.assertTrue(np.array_equal(final[:, 2], rest[:, 2]))


class CanisterTet(SmallChecks, unittest.TestCase):
    model, kind = "canister", "tet"


class CourierHex(SmallChecks, unittest.TestCase):
    model, kind = "courier", "hex"

    def test_every_parameter_changes_by_15_to_30_percent(self):
        initial, final = vars(self.geometry.initial), vars(self.geometry.final)
        self.assertEqual(len(initial), 8)
        for name in initial:
            change = abs(final[name] / initial[name] - 1)
            self.assertTrue(0.15 - 1e-12 <= change <= 0.3 + 1e-12, name)


class CourierTet(SmallChecks, unittest.TestCase):
    model, kind = "courier", "tet"

    def test_same_call_same_mesh(self):
        again = self.geometry.tet_mesh(small=True)
        self.assertTrue(np.array_equal(again.points, self.mesh.points))
        self.assertTrue(np.array_equal(again.cells, self.mesh.cells))


class BoreTwistHex(MeshChecks, unittest.TestCase):
    model, kind = "bore_twist", "hex"

    def test_top_turns_and_foot_does_not(self):
        final, rest = self.mesh.moved(1), self.mesh.points
        turn = np.angle((final[:, 0] + 1j * final[:, 1]) / (rest[:, 0] + 1j * rest[:, 1]), deg=True)
        rise = rest[:, 2] / 12
        nodes = self.mesh.nodes
        self.assertLess(np.abs(turn[nodes] + 30 * rise[nodes]).max(), 1e-10)


class BoreTwistTet(MeshChecks, unittest.TestCase):
    model, kind = "bore_twist", "tet"


class CanisterBlindHex(MeshChecks, unittest.TestCase):
    model, kind = "canister_blind", "hex"
    furthest = 1.3  # its few cells are large for the last gap

    def test_bottom_and_wall_stay(self):
        surfaces = self.geometry.Surface
        on = self.geometry.on_surfaces(self.mesh.places)
        still = self.mesh.nodes[on[:, surfaces.BOTTOM] | on[:, surfaces.WALL]]
        self.assertTrue(np.array_equal(self.mesh.moved(1)[still], self.mesh.points[still]))


class CanisterBlindTet(MeshChecks, unittest.TestCase):
    model, kind = "canister_blind", "tet"
    furthest = 1.3


class Files(unittest.TestCase):
    """What Data/generate.py writes."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.output = Path(cls.folder.name) / "made" / "here"
        cls.process = subprocess.run(
            ["pvpython", str(ROOT / "Data" / "generate.py"), "pipe", "--kind", "hex", "--size",
             "small", "--steps", "4", "--output", str(cls.output)],
            capture_output=True, text=True, timeout=400)

    def test_runs_without_a_complaint(self):
        self.assertEqual(self.process.returncode, 0, self.process.stderr)
        self.assertEqual(self.process.stderr.strip(), "")
        self.assertIn("2,880", self.process.stdout)

    def test_series_play_in_paraview(self):
        mesh = Models.get("pipe").hex_mesh(small=True)
        for name, nodes, cells in (
            ("boundary", mesh.nodes, mesh.face_surface),
            ("curves", mesh.curve_nodes, mesh.curve_edges()[1]),
        ):
            with self.subTest(name=name):
                path = self.output / f"pipe_hex_small_{name}.pvd"
                reader = simple.PVDReader(FileName=str(path))
                self.assertEqual(list(reader.TimestepValues), [0, 0.25, 0.5, 0.75, 1])
                reader.UpdatePipeline(0.75)
                data = reader.GetClientSideObject().GetOutputDataObject(0)
                points = vtk_to_numpy(data.GetPoints().GetData())
                self.assertTrue(np.array_equal(points, mesh.moved(0.75)[nodes]))
                arrays = data.GetPointData()
                ids = vtk_to_numpy(arrays.GetArray("MorphPointId"))
                self.assertTrue(np.array_equal(ids, nodes))
                rest = vtk_to_numpy(arrays.GetArray("RestPosition"))
                self.assertTrue(np.array_equal(rest[:, :3], mesh.points[nodes]))
                self.assertTrue(np.all(rest[:, 3] == 1))
                ids = vtk_to_numpy(data.GetCellData().GetArray("GeometryId"))
                self.assertTrue(np.array_equal(ids, cells))

    def test_refuses_what_it_does_not_know(self):
        for wrong in (["bord"], ["--steps", "0"], ["--kind", "wedge"]):
            process = subprocess.run(
                ["pvpython", str(ROOT / "Data" / "generate.py"), *wrong],
                capture_output=True, text=True, timeout=400)
            self.assertEqual(process.returncode, 2)
            self.assertIn("generate.py: error:", process.stderr)


class Picture(unittest.TestCase):
    def test_is_drawn(self):
        with tempfile.TemporaryDirectory() as folder:
            process = subprocess.run(
                ["pvpython", "--force-offscreen-rendering",
                 str(ROOT / "Utilities" / "models_picture.py"), "pipe", "--output", folder],
                capture_output=True, text=True, timeout=400)
            self.assertEqual(process.returncode, 0, process.stderr)
            reader = vtkPNGReader()
            reader.SetFileName(str(Path(folder) / "models-pipe.png"))
            reader.Update()
            image = reader.GetOutput()
        self.assertEqual(image.GetDimensions()[0], 1600)
        pixels = vtk_to_numpy(image.GetPointData().GetScalars()).astype(int)
        painted = np.count_nonzero(np.ptp(pixels, axis=1) > 30) / len(pixels)
        self.assertGreater(painted, 0.1)


class BadInput(unittest.TestCase):
    def test_unknown_names(self):
        with self.assertRaisesRegex(ValueError, "no model 'bord': one of bore, pipe, canister"):
            Models.get("bord")
        with self.assertRaisesRegex(ValueError, "no kind of mesh 'wedge'"):
            Models.get("bore").make("wedge")

    def test_no_solid(self):
        for name, past in (("bore", 1.6), ("pipe", 2.0), ("canister", 1.5), ("courier", 1.85),
                           ("canister_blind", 1.5)):
            model = Models.get(name)
            model.parameters(model.last)
            with self.subTest(name=name), self.assertRaises(ValueError):
                model.parameters(past)

    def test_points_off_the_surface(self):
        for name in Models.NAMES:
            model = Models.get(name)
            mesh = model.read_small("hex")
            points = mesh.points[mesh.nodes]
            surface = np.flatnonzero(mesh.geometry_dimension[mesh.nodes] == 2)[7]
            kind = mesh.geometry_id[mesh.nodes[[surface]]]
            shift = 1e-6 * model.normals(kind, points[[surface]], model.initial)[0]
            for wrong in (points[surface] + shift, points[surface] - shift, np.full(3, np.nan)):
                moved = points.copy()
                moved[surface] = wrong
                with self.subTest(name=name, wrong=wrong):
                    with self.assertRaisesRegex(ValueError, rf"points \[{surface}\]"):
                        model.locate(moved)

    def test_files_that_are_no_model(self):
        from Models.model_mesh import read_mesh
        with self.assertRaisesRegex(FileNotFoundError, "there is no mesh"):
            read_mesh(Path("nowhere.vtu"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
