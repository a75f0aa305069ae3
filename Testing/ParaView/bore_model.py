# SPDX-License-Identifier: BSD-3-Clause
"""The bore's meshes and boundary positions, checked against the paper's counts, the analytic
surfaces written out here once more as equations, and VTK. Needs pvpython and Gmsh, not the
plugin."""

import math
import sys
import unittest
from pathlib import Path

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter
from vtkmodules.vtkFiltersVerdict import vtkCellSizeFilter, vtkMeshQuality

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "Data"))
from Models import bore, bore_mesh  # noqa: E402  (needs the path above)


def scaled_jacobian(mesh):
    quality = vtkMeshQuality()
    quality.SetTetQualityMeasureToScaledJacobian()
    quality.SetHexQualityMeasureToScaledJacobian()
    quality.SetInputData(mesh.to_vtk())
    quality.Update()
    return vtk_to_numpy(quality.GetOutput().GetCellData().GetArray("Quality"))


def surface_of(grid):
    surface = vtkDataSetSurfaceFilter()
    surface.SetInputData(grid)
    surface.PassThroughPointIdsOn()
    surface.Update()
    return surface.GetOutput()


def surface_normals(grid):
    """(#faces, 3): unit normals of the boundary's triangles or quadrilaterals."""
    surface = surface_of(grid)
    size = surface.GetCell(0).GetNumberOfPoints()
    faces = vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, size)
    p = vtk_to_numpy(surface.GetPoints().GetData())[faces]
    normal = np.cross(p[:, 2] - p[:, 0], p[:, -1] - p[:, 1])
    return normal / np.linalg.norm(normal, axis=1)[:, None]


def volume(mesh):
    sizes = vtkCellSizeFilter()
    sizes.SetInputData(mesh.to_vtk())
    sizes.ComputeSumOn()
    sizes.Update()
    return sizes.GetOutput().GetFieldData().GetArray("Volume").GetValue(0)


def bore_volume(p):
    half = math.radians(p.cone_angle) / 2
    depth = (p.mouth_radius - p.bore_radius) / math.tan(half)
    frustum = math.pi * depth / 3 * (
        p.mouth_radius**2 + p.mouth_radius * p.bore_radius + p.bore_radius**2
    )
    return (
        math.pi * p.outer_radius**2 * p.height
        - math.pi * p.bore_radius**2 * (p.height - depth)
        - frustum
    )


def surface_distances(p, points):
    """(#surfaces, #points): distance to each of the unbounded cone, cylinders and planes, in
    Surface's order."""
    r, z = np.hypot(points[:, 0], points[:, 1]), points[:, 2]
    half = math.radians(p.cone_angle) / 2
    cone = (r - p.mouth_radius) * math.cos(half) - (z - p.height) * math.sin(half)
    return np.abs([cone, r - p.bore_radius, r - p.outer_radius, z - p.height, z])


# The surfaces that meet in each circle, in Circle's order.
CIRCLE_SURFACES = [(0, 3), (0, 1), (1, 4), (2, 3), (2, 4)]


class Parameters(unittest.TestCase):
    def test_path_of_the_countersink(self):
        self.assertAlmostEqual(bore.S_0.cone_depth, 0.8660254037844386, delta=1e-14)
        self.assertAlmostEqual(bore.S_F.cone_depth, 3.7320508075688774, delta=1e-13)
        self.assertEqual(bore.S_0.toward(bore.S_F, 0), bore.S_0)
        self.assertEqual(bore.S_0.toward(bore.S_F, 1), bore.S_F)
        self.assertEqual(bore.S_0.toward(bore.S_F, 0.5).cone_angle, 45)

    def test_no_bore(self):
        bore.S_0.toward(bore.S_F, 1.58)
        for numbers in [
            (12, 2.5, 2, 3, 60),
            (12, 2, 3, 3, 60),
            (12, 0, 1, 3, 60),
            (12, 2, 2.5, 3, 180),
            (0.8, 2, 2.5, 3, 60),
        ]:
            with self.subTest(numbers), self.assertRaises(ValueError):
                bore.BoreParameters(*numbers)
        with self.assertRaises(ValueError):
            bore.S_0.toward(bore.S_F, 1.6)


class MeshChecks:
    """What both meshes must hold; a subclass makes `mesh`, `nodes` and `places`."""

    def test_every_node_is_used(self):
        used = np.unique(self.mesh.cells)
        self.assertTrue(np.array_equal(used, np.arange(len(self.mesh.points))))

    def test_boundary_nodes_are_vtks_surface(self):
        surface = surface_of(self.mesh.to_vtk())
        ids = surface.GetPointData().GetArray("vtkOriginalPointIds")
        self.assertTrue(np.array_equal(np.sort(vtk_to_numpy(ids)), self.nodes))

    def test_cells_are_good(self):
        quality = scaled_jacobian(self.mesh)
        self.assertGreater(quality.min(), self.least_quality)
        self.assertLessEqual(quality.max(), 1 + 1e-12)

    def test_volume(self):
        # Flat cell faces cut the circles: a 62-gon's area is short of its circle by 0.17 %.
        self.assertAlmostEqual(volume(self.mesh) / bore_volume(bore.S_0), 1, delta=0.002)

    def test_positions_at_rest_are_the_meshs_own(self):
        own = self.mesh.points[self.nodes]
        self.assertTrue(np.array_equal(self.places.positions(bore.S_0), own))

    def test_positions_lie_on_their_surfaces_and_keep_their_angle(self):
        places, rest = self.places, self.mesh.points[self.nodes]
        for t in (0.0, 0.37, 1.0, 1.5):
            shape = bore.S_0.toward(bore.S_F, t)
            moved = places.positions(shape)
            distance = surface_distances(shape, moved)
            inside = np.flatnonzero(places.dimension == 2)
            self.assertLess(distance[places.entity[inside], inside].max(), 1e-12)
            on_circle = np.flatnonzero(places.dimension < 2)
            for surfaces in np.array(CIRCLE_SURFACES)[places.entity[on_circle]].T:
                self.assertLess(distance[surfaces, on_circle].max(), 1e-12)
            turn = np.arctan2(moved[:, 1], moved[:, 0]) - np.arctan2(rest[:, 1], rest[:, 0])
            self.assertLess(np.abs(turn).max(), 1e-14)

    def test_moved_faces_do_not_turn_over(self):
        # The cone's wall turns by 15 degrees, the others not at all.
        grid = self.mesh.to_vtk()
        rest = surface_normals(grid)
        vtk_to_numpy(grid.GetPoints().GetData())[self.nodes] = self.places.positions(bore.S_F)
        grid.GetPoints().Modified()
        cosine = np.sum(rest * surface_normals(grid), axis=1)
        self.assertGreater(cosine.min(), 0.9)
        self.assertLess(cosine.min(), 0.98)


class HexMesh(MeshChecks, unittest.TestCase):
    least_quality = 0.80

    @classmethod
    def setUpClass(cls):
        cls.mesh, cls.nodes, cls.places = bore_mesh.hex_mesh()

    def test_counts_are_the_papers(self):
        self.assertEqual(self.mesh.points.shape, (15190, 3))
        self.assertEqual(self.mesh.cells.shape, (11904, 8))
        self.assertEqual(len(self.nodes), 6448)
        dimensions = np.bincount(self.places.dimension)
        self.assertEqual(dimensions.tolist(), [5, 5 * 61, 6448 - 5 * 62])

    def test_mesh_made_at_the_final_shape(self):
        quality = scaled_jacobian(bore_mesh.hex_mesh(bore.S_F)[0])
        self.assertAlmostEqual(quality.min(), 0.5667, delta=1e-4)

    def test_moved_boundary_is_that_of_a_mesh_made_there(self):
        for t in (0.37, 1.0, 1.5):
            shape = bore.S_0.toward(bore.S_F, t)
            mesh, nodes, _ = bore_mesh.hex_mesh(shape)
            self.assertLess(np.abs(self.places.positions(shape) - mesh.points[nodes]).max(), 1e-12)

    def test_point_off_the_surface(self):
        points = self.mesh.points[self.nodes]
        points[7] *= 1.0001
        with self.assertRaisesRegex(ValueError, r"points \[7\]"):
            bore.locate(bore.S_0, points)


class TetMesh(MeshChecks, unittest.TestCase):
    least_quality = 0.15

    @classmethod
    def setUpClass(cls):
        cls.mesh, cls.nodes, cls.places = bore_mesh.tet_mesh()

    def test_counts_are_near_the_papers(self):
        self.assertLess(abs(len(self.mesh.points) / 21859 - 1), 0.1)
        self.assertLess(abs(len(self.mesh.cells) / 109535 - 1), 0.1)
        self.assertEqual(np.count_nonzero(self.places.dimension == 0), 5)

    def test_same_call_same_mesh(self):
        first, second = (bore_mesh.tet_mesh(size=0.5)[0] for _ in range(2))
        self.assertTrue(np.array_equal(first.points, second.points))
        self.assertTrue(np.array_equal(first.cells, second.cells))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
