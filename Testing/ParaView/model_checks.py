# SPDX-License-Identifier: BSD-3-Clause
"""What every mesh of every model must hold. A test class names `model`, `kind` and `small`."""

import sys
from pathlib import Path

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter
from vtkmodules.vtkFiltersVerdict import vtkMeshQuality

import model_equations

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "Data"), str(ROOT / "Utilities")]
import Models  # noqa: E402  (needs the path above)

STEPS = [step / 20 for step in range(21)]  # the paper's S_0 ... S_F
LEAST_QUALITY = {"hex": 0.3, "tet": 0.15}


def scaled_jacobian(mesh):
    quality = vtkMeshQuality()
    quality.SetTetQualityMeasureToScaledJacobian()
    quality.SetHexQualityMeasureToScaledJacobian()
    quality.SetInputData(mesh.to_vtk())
    quality.Update()
    return vtk_to_numpy(quality.GetOutput().GetCellData().GetArray("Quality"))


def vtk_surface_nodes(grid):
    surface = vtkDataSetSurfaceFilter()
    surface.SetInputData(grid)
    surface.PassThroughPointIdsOn()
    surface.Update()
    ids = surface.GetOutput().GetPointData().GetArray("vtkOriginalPointIds")
    return np.sort(vtk_to_numpy(ids))


def corner_normals(points, faces):
    """(corners, #faces, 3): unit normals at each corner of triangles or quadrilaterals. A face is
    inverted where one of them points inward."""
    corners = points[faces]
    after = np.roll(corners, -1, axis=1) - corners
    normal = np.cross(after, np.roll(corners, 1, axis=1) - corners)
    return np.moveaxis(normal / np.linalg.norm(normal, axis=2)[..., None], 1, 0)


def enclosed_volume(points, faces):
    """By the divergence theorem, of a surface of triangles and of quadrilaterals in two halves."""
    corners = points[faces]
    volume = 0.0
    for last in range(2, faces.shape[1]):
        normal = np.cross(corners[:, last - 1] - corners[:, 0], corners[:, last] - corners[:, 0])
        volume += np.sum(corners[:, 0] * normal) / 6
    return volume


class MeshChecks:
    """`mesh` is made once for all. furthest: up to which t no face may turn over; default the
    model's last."""

    model, kind, small = "", "", True
    furthest = None

    @classmethod
    def setUpClass(cls):
        cls.geometry = Models.get(cls.model)
        cls.mesh = cls.geometry.make(cls.kind, cls.small)
        cls.equations = staticmethod(getattr(model_equations, cls.model))
        cls.size = np.ptp(cls.mesh.points, axis=0).max()

    def surfaces_of(self, node):
        """Ids of the surfaces that meet in the geometry that owns this node."""
        number = self.mesh.geometry_id[node]
        dimension = self.mesh.geometry_dimension[node]
        if dimension == 2:
            return [number]
        return list(self.geometry.curves[number].surfaces if dimension == 1
                    else self.geometry.vertices[number][0])

    def test_nodes(self):
        mesh = self.mesh
        self.assertTrue(np.array_equal(np.unique(mesh.cells), np.arange(len(mesh.points))))
        self.assertTrue(np.array_equal(vtk_surface_nodes(mesh.to_vtk()), mesh.nodes))
        self.assertTrue(np.array_equal(np.unique(mesh.faces), mesh.nodes))
        on_boundary = np.flatnonzero(mesh.geometry_dimension < 3)
        self.assertTrue(np.array_equal(on_boundary, mesh.nodes))

    def test_cells_are_good(self):
        quality = scaled_jacobian(self.mesh)
        self.assertGreater(quality.min(), LEAST_QUALITY[self.kind])
        self.assertLessEqual(quality.max(), 1 + 1e-12)

    def test_positions_at_rest_are_the_meshs_own(self):
        rest = self.mesh.points[self.mesh.nodes]
        self.assertTrue(np.array_equal(self.mesh.boundary_positions(0), rest))

    def test_positions_are_the_same_at_each_call(self):
        places, shape = np.tile(self.mesh.places, (4, 1)), self.geometry.parameters(0.37)
        first = self.geometry.positions(places, shape)
        sizes = np.random.default_rng(7).integers(1, 200_000, (150, 6))
        for row in sizes:
            others = [np.empty(size) for size in row]  # so that addresses change
            again = self.geometry.positions(places.copy(), shape)
            self.assertTrue(np.array_equal(again, first))
            del others

    def test_positions_lie_on_their_surfaces(self):
        mesh = self.mesh
        pairs = [(row, surface) for row, node in enumerate(mesh.nodes)
                 for surface in self.surfaces_of(node)]
        row, surface = np.array(pairs).T
        for t in (0.0, 0.37, 1.0, self.geometry.last):
            shape = self.geometry.parameters(t)
            distance = self.equations(shape, mesh.boundary_positions(t))
            self.assertLess(np.abs(distance[surface, row]).max(), 1e-13 * self.size)

    def test_faces_are_on_their_surface(self):
        distance = self.equations(self.geometry.initial, self.mesh.points)
        for corner in self.mesh.faces.T:
            on = np.abs(distance[self.mesh.face_surface, corner])
            self.assertLess(on.max(), 1e-13 * self.size)
        self.assertEqual(np.unique(self.mesh.face_surface).tolist(),
                         [int(surface) for surface in self.geometry.Surface])

    def test_point_arrays_alone_tell_the_faces_surfaces(self):
        mesh = self.mesh
        inside = mesh.geometry_dimension[mesh.faces] == 2
        self.assertTrue(np.all(inside.any(axis=1)))
        corner = np.argmax(inside, axis=1)
        node = mesh.faces[np.arange(len(corner)), corner]
        self.assertTrue(np.array_equal(mesh.geometry_id[node], mesh.face_surface))

    def mesh_beyond(self):
        """The mesh that is moved beyond t = 1, where what it bears depends on each of its faces."""
        return self.mesh

    def test_no_face_turns_over(self):
        for t in [*STEPS, self.furthest or self.geometry.last]:
            mesh = self.mesh if t <= 1 else self.mesh_beyond()
            points = mesh.moved(t)
            centers = points[mesh.faces].mean(axis=1)
            true = model_equations.normals(
                self.equations, self.geometry.parameters(t), mesh.face_surface, centers)
            least = np.sum(corner_normals(points, mesh.faces) * true, axis=2).min()
            self.assertGreater(least, 0.9 if t <= 1 else 0.5, f"t = {t}")

    def test_volume(self):
        # Flat faces cut circles short: of a 24-gon's area 1.1 %, and twice that of a thin wall's.
        for t in (0, 1):
            true = getattr(model_equations, f"{self.model}_volume")(self.geometry.parameters(t))
            self.assertAlmostEqual(self.geometry.volume(self.geometry.parameters(t)) / true, 1,
                                   delta=1e-13)
            enclosed = enclosed_volume(self.mesh.moved(t), self.mesh.faces)
            self.assertAlmostEqual(enclosed / true, 1, delta=0.03 if self.small else 0.006)

    def test_every_vertex_is_one_node(self):
        vertices = self.mesh.geometry_id[self.mesh.geometry_dimension == 0]
        self.assertEqual(np.sort(vertices).tolist(), list(range(len(self.geometry.vertices))))

    def test_curves_are_chains(self):
        mesh = self.mesh
        edges, numbers = mesh.curve_edges()
        for number, curve in enumerate(self.geometry.curves):
            with self.subTest(curve=number):
                ends, degree = np.unique(edges[numbers == number], return_counts=True)
                interior = np.flatnonzero(
                    (mesh.geometry_dimension == 1) & (mesh.geometry_id == number))
                vertices = np.setdiff1d(ends, interior)
                self.assertEqual(len(ends), len(interior) + (1 if curve.closed else 2))
                self.assertTrue(np.all(mesh.geometry_dimension[vertices] == 0))
                self.assertTrue(np.all(degree[~np.isin(ends, vertices)] == 2))
                self.assertTrue(np.all(degree[np.isin(ends, vertices)] == 1 + curve.closed))
                self.assertTrue(np.all((mesh.curve_parameter[interior] > 0)
                                       & (mesh.curve_parameter[interior] < 1)))

    def test_curve_parameters_are_fractions_of_the_arc_length(self):
        mesh = self.mesh
        edges, numbers = mesh.curve_edges()
        rest, final = mesh.points, mesh.moved(1)
        for points in (rest, final):
            chord = np.linalg.norm(points[edges[:, 1]] - points[edges[:, 0]], axis=1)
            for number, curve in enumerate(self.geometry.curves):
                here = numbers == number
                parameter = self.parameters_on(number, edges[here])
                step = np.abs(parameter[:, 1] - parameter[:, 0])
                if curve.closed:
                    step = np.minimum(step, 1 - step)
                    self.assertAlmostEqual(step.sum(), 1, delta=1e-12)
                    radius = chord[here] / (2 * np.sin(np.pi * step))
                    self.assertLess(np.ptp(radius), 1e-9 * self.size)
                else:
                    self.assertAlmostEqual(step.sum(), 1, delta=1e-12)
                    self.assertLess(np.ptp(chord[here] / step), 1e-9 * self.size)

    def parameters_on(self, number, edges):
        """(#edges, 2): parameters of the ends of a curve's edges."""
        parameter = self.mesh.curve_parameter[edges]
        if not self.geometry.curves[number].closed:
            last = self.geometry.curve_ends(number)[1]
            on_last = (self.mesh.geometry_dimension[edges] == 0) & (
                self.mesh.geometry_id[edges] == last)
            parameter = np.where(on_last, 1.0, parameter)
        return parameter

    def test_curve_positions(self):
        mesh = self.mesh
        expected = mesh.moved(0.55)[mesh.curve_nodes]
        self.assertTrue(np.array_equal(mesh.curve_positions(0.55), expected))
        self.assertEqual(len(mesh.curve_nodes), np.count_nonzero(mesh.geometry_dimension < 2))
