# SPDX-License-Identifier: BSD-3-Clause
"""What must hold where Classify Boundary and Morph Boundary work on a mesh of a model. A test class
names `model`, `kind` and `small`."""

import csv
import os

import numpy as np
from paraview import simple
from vtkmodules.util.numpy_support import vtk_to_numpy

import model_equations
from model_checks import Models, ROOT
from true_surface import true_surface

import models_folds  # noqa: E402  (model_checks puts its folder on the path)
from models_folds import MovedSurfaces, output, producer
from Models.model_mesh import vtk_points

simple.LoadPlugin(os.environ["MESHMORPHING_PLUGIN"], remote=False, ns=vars(simple))

# Where surfaces of a model continue each other without an edge, no angle parts them.
SMOOTH = {"pipe": [(0, 1, 2), (3, 4, 5)]}


def number(proxy, name):
    """A property that the last execution left."""
    proxy.UpdatePipeline()
    proxy.UpdatePropertyInformation()
    return proxy.GetProperty(name).GetData()


def point_array(data, name):
    return vtk_to_numpy(data.GetPointData().GetArray(name))


def faces_by_nodes(surface):
    """Sorted node ids of each polygon of a boundary that travels: its id in the cell array
    GeometryId."""
    nodes = point_array(surface, "MorphPointId")
    polygons = surface.GetPolys()
    offsets = vtk_to_numpy(polygons.GetOffsetsArray())
    corners = nodes[vtk_to_numpy(polygons.GetConnectivityArray())]
    ids = vtk_to_numpy(surface.GetCellData().GetArray("GeometryId"))
    return {tuple(sorted(corners[a:b])): number
            for a, b, number in zip(offsets, offsets[1:], ids)}


class BoundaryChecks:
    """`pieces`: into how many each edge of the target's faces is cut. `angle`: a feature angle that
    parts the mesh's surfaces."""

    model, kind, small = "", "", True
    pieces = 4
    angle = 25

    @classmethod
    def setUpClass(cls):
        model = Models.get(cls.model)
        cls.mesh = model.read_small(cls.kind) if cls.small else model.make(cls.kind)
        cls.equations = staticmethod(getattr(model_equations, cls.model))
        cls.size = np.ptp(cls.mesh.points, axis=0).max()

    def moved_surfaces(self, method=models_folds.METHODS[0]):
        surfaces = MovedSurfaces(self.mesh, method)
        self.addCleanup(surfaces.remove)
        return surfaces

    def with_moved_curves(self, map_points):
        """MovedSurfaces whose vertices and curves are moved by a map of points (n, 3)."""
        surfaces = self.moved_surfaces()
        curves = self.mesh.curves_to_vtk(0)
        curves.SetPoints(vtk_points(map_points(self.mesh.points[self.mesh.curve_nodes])))
        surfaces.give(curves)
        return surfaces

    def assert_projected_onto(self, surfaces, target, t):
        """All surface nodes are on their true surface within 1e-3 of the model's size, and no face
        is folded."""
        surfaces.filter.Target = target
        surfaces.move_to(t)
        dimension = self.mesh.geometry_dimension
        nodes = np.flatnonzero(dimension == 2)
        self.assertEqual(number(surfaces.filter, "UnprojectedPoints"), 0)
        self.assertEqual(number(surfaces.filter, "ProjectedPoints"), len(nodes))
        distance = self.equations(self.mesh.model.parameters(t), surfaces.moved)
        off = np.abs(distance[self.mesh.geometry_id[nodes], nodes]).max()
        print(f"\n{self.model} {self.kind}: surface nodes within {off / self.size:.1e} of the size",
              flush=True)
        self.assertLess(off, 1e-3 * self.size)
        self.assertEqual(number(surfaces.filter, "FoldedFaces"), 0)
        self.assertEqual(len(surfaces.folded(t)), 0)
        on_curves = surfaces.moved[self.mesh.curve_nodes]
        self.assertTrue(np.array_equal(on_curves, self.mesh.curve_positions(t)))

    def test_projected_surfaces_are_the_true_ones(self):
        target = producer(true_surface(self.mesh, self.equations, 1, self.pieces))
        self.addCleanup(simple.Delete, target)
        self.assert_projected_onto(self.moved_surfaces(), target, 1)


class SmallBoundaryChecks(BoundaryChecks):
    def test_folds_are_those_of_the_data_file(self):
        with open(models_folds.DATA, encoding="utf-8") as file:
            data = [row for row in csv.DictReader(file)
                    if (row["size"], row["model"], row["kind"]) == ("small", self.model, self.kind)]
        found = [{**row, "commit": expected["commit"]} for row, expected in zip(
            models_folds.rows(self.mesh, "small", self.kind), data, strict=True)]
        self.assertEqual([{k: str(v) for k, v in row.items()} for row in found],
                         [dict(row) for row in data])

    def test_filter_finds_the_same_folds(self):
        for method in models_folds.METHODS:
            surfaces = self.moved_surfaces(method)
            for t in (0.5, 1):
                surfaces.move_to(t)
                with self.subTest(method=method, t=t):
                    folded = len(surfaces.folded(t))
                    self.assertEqual(number(surfaces.filter, "FoldedFaces"), folded)
                    self.assertEqual(number(surfaces.filter, "MinScaledJacobian") <= 0, folded > 0)

    def test_no_motion_returns_every_node(self):
        for method in models_folds.METHODS:
            surfaces = self.moved_surfaces(method)
            for dimension in ("Vertices", "Vertices and curves"):
                surfaces.filter.PrescribedDimension = dimension
                surfaces.move_to(0)
                self.assertTrue(np.array_equal(surfaces.moved, self.mesh.points))

    def test_affine_motions(self):
        """Of the curves in any way. Of the vertices alone in any way that they tell: each circle
        has but one vertex, and in bore, pipe and canister all are in the plane y = 0. Those of the
        bore are nearly on a line: nodes lie 12 times as far from it, and the motion counts in
        part, bounded by 10 times that of the vertices."""
        nodes = self.mesh.nodes
        general = np.array([[1.2, 0.3, -0.1], [0.2, 0.8, 0.4], [0.1, -0.3, 1.1]])
        plane = np.array([[1.2, 0, 0.3], [0, 1, 0], [0.1, 0, 0.9]])
        vertices = self.mesh.geometry_dimension == 0
        cases = [(general, "Vertices and curves"), (plane, "Vertices")]
        if self.model == "courier":
            cases.append((general, "Vertices"))
        for matrix, dimension in cases:
            surfaces = self.with_moved_curves(lambda x: x @ matrix.T + [3, -2, 1])
            for method in models_folds.METHODS:
                surfaces.filter.SurfaceMethod = method
                surfaces.filter.PrescribedDimension = dimension
                surfaces.update()
                expected = self.mesh.points @ matrix.T + [3, -2, 1]
                exact = vertices if self.model == "bore" and dimension == "Vertices" else nodes
                with self.subTest(dimension=dimension, method=method):
                    off = np.abs(surfaces.moved[exact] - expected[exact]).max()
                    self.assertLess(off, 1e-10 * self.size)
                    motion = np.linalg.norm(surfaces.moved - self.mesh.points, axis=1)
                    self.assertLess(motion[nodes].max(), 10 * motion[vertices].max())

    def classified(self, **options):
        filter_ = simple.ClassifyBoundary(Input=producer(self.mesh.to_vtk()), **options)
        self.addCleanup(simple.Delete, filter_)
        filter_.UpdatePipeline()
        return filter_

    def test_given_ids_come_back(self):
        filter_ = self.classified()
        grid, mesh = output(filter_), self.mesh
        dimension = point_array(grid, "GeometryDimension")
        self.assertTrue(np.array_equal(dimension, mesh.geometry_dimension))
        on = mesh.geometry_dimension < 3
        self.assertTrue(np.array_equal(point_array(grid, "GeometryId")[on], mesh.geometry_id[on]))
        parameter = point_array(grid, "CurveParameter")
        self.assertLess(np.abs(parameter - mesh.curve_parameter).max(), 1e-12)
        model = mesh.model
        self.assertEqual(
            [number(filter_, f"NumberOf{what}") for what in ("Vertices", "Curves", "Surfaces")],
            [len(model.vertices), len(model.curves), len(model.Surface)])
        found = faces_by_nodes(output(filter_, 1))
        expected = {tuple(sorted(face)): surface
                    for face, surface in zip(mesh.faces, mesh.face_surface)}
        self.assertEqual(found, expected)

    def test_geometry_by_feature_angle(self):
        filter_ = self.classified(UseGeometryArrays=0, FeatureAngle=self.angle)
        found = faces_by_nodes(output(filter_, 1))
        merged = {s: group[0] for group in SMOOTH.get(self.model, []) for s in group}
        sharp = [curve for curve in self.mesh.model.curves
                 if len({merged.get(s, s) for s in curve.surfaces}) == 2]
        self.assertEqual(number(filter_, "NumberOfCurves"), len(sharp))
        self.assertEqual(number(filter_, "NumberOfVertices"), len(self.mesh.model.corners))
        pairs = {(found[tuple(sorted(face))], merged.get(surface, surface))
                 for face, surface in zip(self.mesh.faces, self.mesh.face_surface.tolist())}
        expected = {merged.get(surface, surface) for surface in self.mesh.face_surface.tolist()}
        self.assertEqual(len(pairs), len(expected))
        self.assertEqual({surface for _, surface in pairs}, expected)
        self.assertEqual(len({ours for ours, _ in pairs}), len(expected))

    def test_vertices_curves_surfaces_volumes(self):
        """The paper's order on a mesh: find the geometry, move its curves, let surfaces and then
        the volume follow."""
        t, mesh = 0.25, self.mesh
        for by_angle in (False, True):
            classified = self.classified(
                UseGeometryArrays=int(not by_angle), FeatureAngle=self.angle)
            surface = output(classified, 1).NewInstance()
            surface.ShallowCopy(output(classified, 1))
            ids = point_array(surface, "MorphPointId")
            surface.SetPoints(vtk_points(mesh.moved(t)[ids]))
            boundary = simple.MorphBoundary(Input=classified, Boundary=producer(surface))
            morphed = simple.MorphFEMWARP(Input=classified, Boundary=boundary)
            with self.subTest(by_angle=by_angle):
                self.assertEqual(number(morphed, "InvertedCells"), 0)
                self.assertEqual(number(boundary, "FoldedFaces"), 0)
                points = vtk_to_numpy(output(morphed).GetPoints().GetData())
                on_surfaces = vtk_to_numpy(output(boundary).GetPoints().GetData())
                ids = point_array(output(boundary), "MorphPointId")
                self.assertTrue(np.array_equal(points[ids], on_surfaces))
                given = np.flatnonzero(point_array(output(classified), "GeometryDimension") < 2)
                self.assertEqual(number(boundary, "GivenPoints"), len(given))
                self.assertTrue(np.array_equal(points[given], mesh.moved(t)[given]))
                self.assertGreater(number(morphed, "MinScaledJacobian"), 0.05)
            simple.Delete(morphed)
            simple.Delete(boundary)
