# SPDX-License-Identifier: BSD-3-Clause
"""Python's package meshmorphing: meshes of arrays, methods, adjoints, quality, repair, and errors.

Run: PYTHONPATH=<folder of meshmorphing> MESHMORPHING_MODELS=<small models> python3 arrays.py
"""
import os
import pickle
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import unittest
import warnings
from pathlib import Path

import meshmorphing as mm
import numpy

try:
    import meshio
except ImportError:
    meshio = None
try:
    import pyvista
except ImportError:
    pyvista = None

ROOT = Path(__file__).resolve().parents[2]
MODELS = Path(os.environ["MESHMORPHING_MODELS"])
LINEAR = (mm.FEMWARP, mm.LBWARP, mm.WeightedResidual, mm.SimplexLinear, mm.SimplexNaturalNeighbor,
          mm.RadialBasis)
AFFINE = numpy.array([[1.1, 0.2, 0], [-0.1, 0.9, 0.1], [0, 0.3, 1.2]])
HEXAHEDRON, WEDGE = 12, 13


def cube(n=6):
    """Points and hexahedra of n cells along each edge of a unit cube, the nodes inside shifted."""
    axis = numpy.linspace(0, 1, n + 1)
    points = numpy.stack(numpy.meshgrid(axis, axis, axis, indexing="ij"), -1).reshape(-1, 3)
    ids = numpy.arange(len(points)).reshape(n + 1, n + 1, n + 1)
    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1),
               (0, 1, 1)]
    cells = numpy.stack([ids[i:n + i, j:n + j, k:n + k].ravel() for i, j, k in corners], -1)
    inside = numpy.logical_and(points > 0, points < 1).all(axis=1)
    shift = numpy.random.default_rng(1).uniform(-0.2 / n, 0.2 / n, points.shape)
    return points + inside[:, None] * shift, cells


def wedges(cells):
    """Each hexahedron as two wedges."""
    halves = cells[:, [0, 1, 2, 4, 5, 6]], cells[:, [0, 2, 3, 4, 6, 7]]
    return numpy.concatenate(halves)


def faces_of(cell):
    """The faces of a hexahedron."""
    return [[cell[i] for i in face] for face in (
        (0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))]


def hexahedra():
    points, cells = cube()
    return mm.Mesh(points, [("hexahedron", cells)])


def bend(points, size=0.1):
    return size * numpy.sin(3 * points[:, [1, 2, 0]])


class Meshes(unittest.TestCase):
    def test_all_forms_of_cells_are_the_same_mesh(self):
        points, cells = cube()
        half = len(cells) // 2
        blocks = [("hexahedron", cells[:half]), ("wedge", wedges(cells[half:]))]
        sizes = numpy.repeat([8, 6], [half, 2 * (len(cells) - half)])
        types = numpy.repeat([HEXAHEDRON, WEDGE], [half, len(sizes) - half])
        ids = numpy.concatenate([data.ravel() for _, data in blocks])
        offsets = numpy.concatenate([[0], sizes.cumsum()])
        flat = numpy.insert(ids, offsets[:-1], sizes)
        meshes = {"blocks": mm.Mesh(points, blocks),
                  "offsets": mm.Mesh(points, (offsets, ids, types)),
                  "list": mm.Mesh(points, [offsets, ids, types]),
                  "flat": mm.Mesh(points, flat, types),
                  "lists": mm.Mesh(points.tolist(), flat.tolist(), types.tolist())}
        nodes = meshes["blocks"].boundary.nodes
        expected = mm.morph(meshes["blocks"], nodes, bend(points[nodes]))
        for name, mesh in meshes.items():
            with self.subTest(name):
                self.assertTrue((mesh.types == types).all())
                moved = mm.morph(mesh, nodes, bend(points[nodes]))
                self.assertTrue((moved == expected).all())

    def test_polyhedra_of_blocks_and_of_one_row_are_the_same_mesh(self):
        points, cells = cube(3)
        faces = [faces_of(cell) for cell in cells.tolist()]
        streams = [[6, *(number for face in cell for number in (4, *face))] for cell in faces]
        flat = [number for stream in streams for number in (len(stream), *stream)]
        blocks = mm.Mesh(points, [("polyhedron8", faces)])
        row = mm.Mesh(points, flat, numpy.full(len(cells), 42))
        nodes = blocks.boundary.nodes
        bent = mm.morph(blocks, nodes, bend(points[nodes]))
        self.assertTrue((bent == mm.morph(row, nodes, bend(points[nodes]))).all())
        affine = mm.morph(blocks, nodes, targets=points[nodes] @ AFFINE)
        self.assertLess(abs(affine - points @ AFFINE).max(), 1e-10)
        self.assertEqual(mm.quality(blocks, bent).inverted, 0)

    def test_small_cells_beside_large_ones_are_one_mesh(self):
        coarse, cells = cube(2)
        fine, small = cube(4)
        places, ids = numpy.unique(numpy.vstack([coarse, fine + [1, 0, 0]]).round(12), axis=0,
                                   return_inverse=True)
        mesh = mm.Mesh(places, [("hexahedron", ids[cells]),
                                ("hexahedron", ids[small + len(coarse)])])
        self.assertEqual(len(mesh.surfaces()), 6)
        nodes = mesh.boundary.nodes
        moved = mm.morph(mesh, nodes, targets=places[nodes] @ AFFINE)
        self.assertLess(abs(moved - places @ AFFINE).max(), 1e-10)
        moved = mm.morph(mesh, nodes, bend(places[nodes]))
        half = moved[(places[:, 0] == 1) & (places[:, 1] == 0.25) & (places[:, 2] == 0.5)]
        ends = moved[(places[:, 0] == 1) & (places[:, 1] % 0.5 == 0) & (places[:, 2] == 0.5)]
        self.assertLess(abs(half - ends[:2].mean(axis=0)).max(), 1e-12)  # no gap

    def test_points_of_a_mesh_are_a_view(self):
        mesh = hexahedra()
        self.assertFalse(mesh.points.flags.owndata)
        self.assertTrue(numpy.shares_memory(mesh.points, mesh.points))
        with self.assertRaises(ValueError):
            mesh.points[0] = 0

    def test_surfaces_of_a_cube(self):
        mesh = hexahedra()
        surfaces = mesh.surfaces()
        self.assertEqual([len(s.faces) for s in surfaces], [36] * 6)
        self.assertTrue(numpy.allclose([s.area for s in surfaces], 1, atol=1e-14))
        self.assertEqual({s.name for s in surfaces}, {f"Surface {i}" for i in range(6)})
        self.assertEqual(len(mesh.surfaces(feature_angle=95)), 1)
        boundary = mesh.boundary
        faces = boundary.connectivity.reshape(-1, 4)[surfaces[0].faces]
        self.assertTrue((numpy.unique(faces) == surfaces[0].nodes).all())
        self.assertEqual(len(boundary.nodes), 7**3 - 5**3)

    @unittest.skipUnless(meshio, "meshio is not installed")
    def test_meshio_there_and_back(self):
        part = meshio.read(MODELS / "bore_hex_small.vtu")
        mesh = mm.Mesh(part.points, part.cells)
        nodes = mesh.boundary.nodes
        moved = mm.morph(mesh, nodes, targets=mesh.points[nodes] @ AFFINE)
        with tempfile.TemporaryDirectory() as folder:
            meshio.Mesh(moved, part.cells).write(Path(folder, "moved.vtk"))
            back = meshio.read(Path(folder, "moved.vtk"))
        self.assertTrue((back.points == moved).all())
        self.assertEqual(mm.quality(mm.Mesh(back.points, back.cells)).inverted, 0)

    @unittest.skipUnless(pyvista, "PyVista is not installed")
    def test_pyvista_there_and_back(self):
        grid = pyvista.read(MODELS / "bore_hex_small.vtu")
        mesh = mm.Mesh(grid.points, grid.cells, grid.celltypes)
        nodes = mesh.boundary.nodes
        grid.points = mm.morph(mesh, nodes, targets=mesh.points[nodes] @ AFFINE)
        self.assertEqual(grid.n_points, len(mesh.points))

    def test_wrong_meshes(self):
        points, cells = cube(2)
        block = [("hexahedron", cells)]
        holed = points.copy()
        holed[7] = numpy.nan
        strayed = numpy.where(cells == 5, 99, cells)
        types = numpy.full(len(cells), HEXAHEDRON)
        flat = numpy.insert(cells, 0, 8, axis=1).ravel()
        for text, arguments in {
                r"\(27, 2\); \(n, 3\)": (points[:, :2], block),
                "7": (holed, block),
                "outside 0 to 26: cell ids 1, 3": (points, [("hexahedron", strayed)]),
                "cube with 8 nodes": (points, [("cube", cells)]),
                "tetra with 8 nodes": (points, [("tetra", cells)]),
                "is a volume cell": (points, [("line", cells[:, :2])]),
                "need celltypes": (points, flat),
                "offsets has the shape": (points, [8, 0, 1]),
                "points has complex or masked": (points + 1j, block),
                "hexahedron has complex or masked": (
                    points, [("hexahedron", numpy.ma.masked_equal(cells, 3))]),
                "pair of type and array": (points, [cells]),
                "at nodes 0, 1": (points + 1e60, block),
                "cell 8 of 9": (points, flat, numpy.full(9, HEXAHEDRON)),
                "7 cells have 63": (points, flat, types[:7]),
                "has no cells": (points, [], []),
                "whole numbers": (points, flat.astype(float), types),
                "polyhedron 0 is no stream": (points, flat, numpy.full(8, 42)),
                "faces of polyhedra are missing: cells 0, 1": (
                    points, (8 * numpy.arange(9), cells.ravel(), numpy.full(8, 42))),
                "closed": (points, [("polyhedron8", [faces_of(cells[0])[:5]])])}.items():
            with self.subTest(text), self.assertRaisesRegex(ValueError, text):
                mm.Mesh(*arguments)


class PointsOfNoCell(unittest.TestCase):
    def test_may_be_nan_and_stay(self):
        points, cells = cube(3)
        blocks = [("hexahedron", cells + 1)]
        mesh = mm.Mesh(numpy.vstack([[numpy.nan] * 3, points]), blocks)
        prepared = mm.FEMWARP().prepare(mesh, mesh.boundary.nodes)
        moved = prepared.evaluate(targets=mesh.points[prepared.nodes] @ AFFINE)
        self.assertTrue(numpy.isnan(moved[0]).all())
        self.assertLess(abs(moved[1:] - points @ AFFINE).max(), 1e-10)
        self.assertEqual(mm.quality(mesh, moved).inverted, 0)
        self.assertTrue((mm.repair(mesh, moved, prepared.nodes)[1:] == moved[1:]).all())
        self.assertTrue(numpy.isfinite(prepared.adjoint(moved - mesh.points)).all())


class Faces(unittest.TestCase):
    """Plane meshes and shells."""
    TYPES = {"triangle": lambda quads: numpy.vstack([quads[:, :3], quads[:, [0, 2, 3]]]),
             "quad": lambda quads: quads}

    def square(self, kind, shape=lambda x, y: 0 * x):
        points, cells = cube()
        front = points[:, 2] == 0
        points = points[front]
        quads = (numpy.cumsum(front) - 1)[cells[front[cells[:, 0]]][:, :4]]
        points[:, 2] = shape(*points[:, :2].T)
        return mm.Mesh(points, [(kind, self.TYPES[kind](quads))])

    def test_edges_are_the_boundary(self):
        mesh = self.square("quad")
        self.assertEqual(mesh.points.shape, (49, 3))
        self.assertTrue((numpy.diff(mesh.boundary.offsets) == 2).all())
        self.assertEqual((len(mesh.boundary.cells), mesh.boundary.nodes.max()), (24, 48))
        surfaces = mesh.surfaces()
        self.assertEqual([len(s.faces) for s in surfaces], [6] * 4)
        self.assertTrue(numpy.allclose([s.area for s in surfaces], 1))
        self.assertEqual([len(s.nodes) for s in surfaces], [7] * 4)

    def test_linear_methods_are_exact_and_have_an_adjoint(self):
        for shape in (lambda x, y: 0 * x, lambda x, y: x**2 - y**2 + x * y):
            for kind in self.TYPES:
                mesh = self.square(kind, shape)
                nodes = mesh.boundary.nodes[::-1]
                is_plane = not mesh.points[:, 2].any()
                affine = AFFINE * [1, 1, not is_plane]
                for method in LINEAR if is_plane else (mm.FEMWARP, mm.LBWARP, mm.RadialBasis):
                    with self.subTest(method.__name__, kind=kind, plane=is_plane):
                        prepared = method().prepare(mesh, nodes)
                        moved = prepared.evaluate(targets=mesh.points[nodes] @ affine)
                        self.assertLess(abs(moved - mesh.points @ affine).max(), 1e-9)
                        motion, gradient = bend(mesh.points[nodes]), bend(mesh.points, 1)
                        motion[:, 2] *= not is_plane
                        gradient[:, 2] *= not is_plane
                        change = prepared.evaluate(motion) - mesh.points
                        self.assertAlmostEqual((prepared.adjoint(gradient) * motion).sum(),
                                               (gradient * change).sum(), delta=1e-7)

    def test_a_fold_is_inverted_and_repaired(self):
        mesh = self.square("quad")
        moved = mesh.points.copy()
        inside = numpy.setdiff1d(numpy.arange(49), mesh.boundary.nodes)[0]
        moved[inside] += [0.4, 0.3, 0]
        self.assertGreater(mm.quality(mesh, moved).inverted, 0)
        repaired = mm.repair(mesh, moved, mesh.boundary.nodes)
        self.assertEqual(mm.quality(mesh, repaired).inverted, 0)
        self.assertLess(abs(repaired[:, 2]).max(), 1e-12)

    def test_a_lid_leaves_its_plane(self):
        mesh = self.square("triangle")
        side = mesh.surfaces()[0].nodes
        moved = mm.morph(mesh, side, numpy.full((len(side), 3), [0, 0, 0.3]))
        self.assertTrue((moved[side, 2] == 0.3).all())
        self.assertTrue(0.01 < moved[24, 2] < 0.29)
        with self.assertRaisesRegex(ValueError, r"no nodes 49: ids go from 0 to 48"):
            mm.morph(mesh, [49], [[0, 0, 0]])


class Methods(unittest.TestCase):
    def test_affine_motions_are_exact(self):
        mesh = hexahedra()
        nodes = mesh.boundary.nodes
        for method in LINEAR:
            with self.subTest(method.__name__):
                prepared = method().prepare(mesh, nodes)
                moved = prepared.evaluate(targets=mesh.points[nodes] @ AFFINE)
                self.assertLess(abs(moved - mesh.points @ AFFINE).max(), 1e-10)

    def test_nodes_have_the_callers_order_and_the_rest_stays(self):
        mesh = hexahedra()
        lid = mesh.boundary.nodes[mesh.points[mesh.boundary.nodes, 2] == 1]
        order = numpy.random.default_rng(2).permutation(lid)
        prepared = mm.FEMWARP().prepare(mesh, order)
        moved = prepared.evaluate(bend(mesh.points[order]))
        self.assertTrue((prepared.nodes == order).all())
        self.assertTrue((moved[order] == mesh.points[order] + bend(mesh.points[order])).all())
        others = numpy.setdiff1d(mesh.boundary.nodes, lid)
        self.assertTrue((moved[others] == mesh.points[others]).all())
        free = mm.FEMWARP().prepare(mesh, order, fix_unnamed_boundary=False)
        self.assertGreater(abs(free.evaluate(bend(mesh.points[order]))[others] -
                               mesh.points[others]).max(), 0.01)

    def test_adjoints_are_derivatives(self):
        """Of J = sum of sin(moved points), by central differences along random directions."""
        mesh = hexahedra()
        nodes = mesh.boundary.nodes[::2]
        random = numpy.random.default_rng(3)
        motion, along = 0.01 * random.normal(size=(2, len(nodes), 3))
        for method in LINEAR:
            with self.subTest(method.__name__):
                prepared = method().prepare(mesh, nodes)
                gradient = prepared.adjoint(numpy.cos(prepared.evaluate(motion)))
                step = 1e-3
                ahead, behind = (numpy.sin(prepared.evaluate(motion + sign * step * along)).sum()
                                 for sign in (1, -1))
                self.assertAlmostEqual((gradient * along).sum(), (ahead - behind) / (2 * step), 8)

    def test_a_beam_follows_the_volume_and_has_a_share_in_the_adjoint(self):
        points, cells = cube(3)
        free = len(points)
        beam = numpy.array([[free - 1, free]])  # from a corner outwards
        mesh = mm.Mesh(numpy.vstack([points, [1, 1, 2]]), [("hexahedron", cells), ("line", beam)])
        prepared = mm.FEMWARP().prepare(mesh, mesh.boundary.nodes)
        shift = numpy.tile([0.1, 0.2, 0.3], (len(prepared.nodes), 1))
        self.assertLess(abs(prepared.evaluate(shift)[free] - [1.1, 1.2, 2.3]).max(), 1e-12)
        gradient = numpy.zeros_like(mesh.points)
        gradient[free] = [1, 2, 3]
        self.assertLess(abs(prepared.adjoint(gradient).sum(axis=0) - [1, 2, 3]).max(), 1e-10)

    def test_all_results_are_the_same_in_any_number_of_threads(self):
        self.addCleanup(mm.set_threads, 0)
        mesh = hexahedra()
        nodes = mesh.boundary.nodes
        for method in (*LINEAR, mm.Smoothing, mm.InversionFree):
            with self.subTest(method.__name__):
                results = []
                for count in (1, 4):
                    mm.set_threads(count)
                    prepared = method().prepare(mesh, nodes)
                    results.append(prepared.evaluate(bend(mesh.points[nodes])))
                self.assertTrue((results[0] == results[1]).all())

    def test_threads_of_python_share_a_prepared_method(self):
        mesh = hexahedra()
        prepared = mm.FEMWARP().prepare(mesh, mesh.boundary.nodes)
        motions = [bend(mesh.points[prepared.nodes], 0.02 * i) for i in range(4)]
        expected = [prepared.evaluate(motion) for motion in motions]
        results = [None] * len(motions)

        def run(i):
            results[i] = prepared.evaluate(motions[i])

        threads = [threading.Thread(target=run, args=(i,)) for i in range(len(motions))]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for result, alone in zip(results, expected):
            self.assertTrue((result == alone).all())

    def test_options(self):
        self.assertEqual(repr(mm.FEMWARP(stiffness="inverse_volume", tolerance=1e-8)),
                         "FEMWARP(stiffness='Inverse volume', stiffness_exponent=1.0, "
                         "stiffness_array=None, wall_array=None, tolerance=1e-08)")
        mesh = hexahedra()
        nodes = mesh.boundary.nodes
        motion = bend(mesh.points[nodes])
        plain = mm.FEMWARP().prepare(mesh, nodes).evaluate(motion)
        walls = mesh.points[:, 2] == 0
        for options in ({"stiffness": "Inverse volume"}, {"stiffness": "Wall distance"},
                        {"stiffness": "Wall distance", "wall_array": walls},
                        {"stiffness_array": 1 + mesh.points[:216, 0] ** 2}):
            with self.subTest(options):
                moved = mm.FEMWARP(**options).prepare(mesh, nodes).evaluate(motion)
                self.assertGreater(abs(moved - plain).max(), 1e-5)
        for text, make in {
                "no value 'soft'; there are Uniform": lambda: mm.FEMWARP(stiffness="soft"),
                "from 0 to 4": lambda: mm.FEMWARP(stiffness_exponent=5),
                "whole number from 1 to": lambda: mm.WeightedResidual(number_of_neighbors=2.5),
                "is inf; a whole": lambda: mm.WeightedResidual(number_of_neighbors=numpy.inf),
                "wall_array is NaN at node 0": lambda: mm.FEMWARP(
                    wall_array=numpy.full(343, numpy.nan)).prepare(mesh, nodes),
                "wall_array has 3": lambda: mm.FEMWARP(
                    stiffness="Wall distance", wall_array=[1, 0, 0]).prepare(mesh, nodes)}.items():
            with self.subTest(text), self.assertRaisesRegex(ValueError, text):
                make()
        with self.assertRaises(TypeError):
            mm.RadialBasis(tolerance=1e-8)

    def test_wrong_motions(self):
        mesh = hexahedra()
        nodes = mesh.boundary.nodes
        prepared = mm.FEMWARP().prepare(mesh, nodes)
        motion = bend(mesh.points[nodes])
        holed = motion.copy()
        holed[5, 1] = numpy.nan
        for text, call in {
                str(nodes[5]): lambda: prepared.evaluate(holed),
                r"\(5, 3\); \(218, 3\)": lambda: prepared.evaluate(motion[:5]),
                "gradient has the shape": lambda: prepared.adjoint(motion),
                "no nodes 9999: ids go from 0 to 342": lambda: mm.FEMWARP().prepare(mesh, [9999]),
                "more than once: 3": lambda: mm.FEMWARP().prepare(mesh, [3, 3]),
                "whole numbers": lambda: mm.FEMWARP().prepare(mesh, [0.5]),
                "not a linear method": lambda: mm.Smoothing().prepare(mesh, nodes).adjoint(
                    mesh.points)}.items():
            with self.subTest(text), self.assertRaisesRegex(ValueError, text):
                call()
        with self.assertRaises(TypeError):
            prepared.evaluate()
        for text, call in {
                "mesh is a NoneType": lambda: mm.FEMWARP().prepare(None, nodes),
                "mesh is a ndarray": lambda: mm.quality(mesh.points),
                "mesh is a tuple": lambda: mm.repair((), mesh.points, nodes),
                "method is a str": lambda: mm.morph(mesh, nodes, motion, method="FEMWARP"),
                "method is a type": lambda: mm.morph(mesh, nodes, motion,
                                                     method=mm.FEMWARP)}.items():
            with self.subTest(text), self.assertRaisesRegex(TypeError, text):
                call()
        with self.assertRaises((ValueError, RuntimeError)):
            mm.FEMWARP().prepare(mesh, [], fix_unnamed_boundary=False)

    def test_warnings_are_pythons(self):
        points, cells = cube()
        middle = numpy.flatnonzero((abs(points - 0.5) < 0.1).all(axis=1))
        points[middle] += 0.4  # inverts the cells around
        mesh = mm.Mesh(points, [("hexahedron", cells)])
        with self.assertWarnsRegex(mm.MorphWarning, "cell"):
            mm.FEMWARP().prepare(mesh, mesh.boundary.nodes)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            with self.assertRaises(mm.MorphWarning):
                mm.FEMWARP().prepare(mesh, mesh.boundary.nodes)


class Validity(unittest.TestCase):
    def press(self, depth):
        """A cube whose lid has a dent, and the motion of the nodes of the dent."""
        mesh = hexahedra()
        x, y, z = mesh.points.T
        nodes = numpy.flatnonzero(z == 1)
        motion = numpy.zeros((len(nodes), 3))
        motion[:, 2] = -depth * (numpy.sin(numpy.pi * x[nodes]) * numpy.sin(numpy.pi * y[nodes]))**2
        return mesh, nodes, motion

    def test_quality(self):
        points, cells = cube(2)
        points[13] = 0.5  # the node inside
        mesh = mm.Mesh(points, [("hexahedron", cells), ("quad", cells[:1, :4])])
        found = mm.quality(mesh)
        self.assertTrue(numpy.allclose(found.scaled_jacobian[:-1], 1))
        self.assertTrue(numpy.isnan(found.scaled_jacobian[-1]))
        self.assertEqual((found.inverted, found.degenerate, found.worst_cell), (0, 0, 0))
        points[13] = [0.5, 0.5, 1.1]
        self.assertEqual(mm.quality(mesh, points).inverted, 4)
        points[5, 1] = numpy.nan
        for call in (mm.quality, lambda *given: mm.repair(*given, [])):
            with self.assertRaisesRegex(ValueError, "points has NaN, .* at nodes 5"):
                call(mesh, points)

    def test_inverted_cells_are_repaired(self):
        mesh, nodes, motion = self.press(0.75)
        moved = mm.WeightedResidual().prepare(mesh, nodes).evaluate(motion)
        self.assertGreater(mm.quality(mesh, moved).inverted, 0)
        repaired = mm.repair(mesh, moved, nodes)
        self.assertEqual(mm.quality(mesh, repaired).inverted, 0)
        boundary = mesh.boundary.nodes
        self.assertTrue((repaired[boundary] == moved[boundary]).all())
        again = mm.morph(mesh, nodes, motion, method=mm.WeightedResidual())
        self.assertTrue((again == repaired).all())

    def test_what_stays_inverted_is_an_error(self):
        mesh, nodes, motion = self.press(0.75)
        with self.assertRaisesRegex(mm.MorphError, "repair=True") as caught:
            mm.morph(mesh, nodes, motion, method=mm.WeightedResidual(), repair=False)
        self.assertGreater(len(caught.exception.cells), 0)
        again = pickle.loads(pickle.dumps(caught.exception))
        self.assertEqual((str(again), len(again.cells)),
                         (str(caught.exception), len(caught.exception.cells)))
        moved = caught.exception.points
        self.assertEqual(moved.shape, mesh.points.shape)
        everything = numpy.arange(len(moved))
        with self.assertRaisesRegex(mm.MorphError, "boundary itself inverts") as caught:
            mm.repair(mesh, moved, everything)
        self.assertGreater(len(caught.exception.cells), 0)

    def test_quadratic_cells(self):
        points, cells = cube(2)
        edges = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5),
                 (2, 6), (3, 7)]
        pairs = numpy.sort(cells[:, edges].reshape(-1, 2), axis=1)
        unique, numbers = numpy.unique(pairs, axis=0, return_inverse=True)
        middles = points[unique].mean(axis=1)
        cells = numpy.hstack([cells, len(points) + numbers.reshape(len(cells), 12)])
        mesh = mm.Mesh(numpy.vstack([points, middles]), [("hexahedron20", cells)])
        corners = numpy.flatnonzero(mesh.points[:len(points), 2] == 1)
        moved = mm.morph(mesh, corners, targets=mesh.points[corners] + [0, 0.2, 0.1])
        self.assertLess(abs(moved[len(points):] - moved[unique].mean(axis=1)).max(), 1e-12)


class Process(unittest.TestCase):
    def test_an_interrupt_stops_a_computation(self):
        """It comes from another thread, which needs the lock."""
        points, cells = cube(30)
        mesh = mm.Mesh(points, [("hexahedron", cells)])
        prepared = None
        timer = threading.Timer(0.05, os.kill, (os.getpid(), signal.SIGINT))
        with self.assertRaises(KeyboardInterrupt):
            timer.start()
            prepared = mm.SimplexNaturalNeighbor().prepare(mesh, mesh.boundary.nodes)
        self.assertIsNone(prepared)

    def test_filters_and_arrays_may_lie_in_two_folders(self):
        """Where the folder without the extension is alone, an error says what to do."""
        with tempfile.TemporaryDirectory() as folder:
            package = Path(folder, "meshmorphing")
            Path(package, "vtk").mkdir(parents=True)
            Path(package, "vtk/__init__.py").touch()
            shutil.copy(mm.__file__, package)
            both = f"{folder}:{Path(mm.__file__).parents[1]}"
            code = "import meshmorphing.vtk"
            alone, two, wrong = (
                subprocess.run([sys.executable, "-c", code + more], cwd=folder, text=True,
                               env={"PYTHONPATH": path}, capture_output=True)
                for path, more in ((folder, ""), (both, "; meshmorphing.Mesh"),
                                   (folder, "; meshmorphing.Mesh")))
        self.assertEqual((alone.returncode, alone.stderr), (0, ""))
        self.assertEqual((two.returncode, two.stderr), (0, ""))
        self.assertRegex(wrong.stderr, "ImportError: meshmorphing has no Mesh here: .*pybind11")


class Examples(unittest.TestCase):
    def test_optimization(self):
        try:
            import scipy  # noqa: F401
        except ImportError:
            self.skipTest("SciPy is not installed")
        result = subprocess.run(
            [sys.executable, ROOT / "Examples/optimize_with_scipy.py"], capture_output=True,
            text=True, timeout=300)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        found, hidden = (numpy.array(re.search(name + r": +(.*)", result.stdout)[1].split(), float)
                         for name in ("found", "hidden"))
        self.assertLess(abs(found - hidden).max(), 1e-5)


if __name__ == "__main__":
    unittest.main()
