# SPDX-License-Identifier: BSD-3-Clause
"""What is particular to the bore: the numbers the paper prints, and the structured mesh at them.
Needs pvpython, not the plugin."""

import sys
import unittest

import numpy as np

from model_checks import Models, scaled_jacobian
from Models import bore


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
                bore.BoreShape(*numbers)


class HexMesh(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.mesh = Models.get("bore").hex_mesh()

    def test_counts_are_the_papers(self):
        self.assertEqual(self.mesh.points.shape, (15190, 3))
        self.assertEqual(self.mesh.cells.shape, (11904, 8))
        self.assertEqual(len(self.mesh.nodes), 6448)
        dimensions = np.bincount(self.mesh.geometry_dimension)
        self.assertEqual(dimensions.tolist(), [5, 5 * 61, 6448 - 5 * 62, 15190 - 6448])

    def test_quality(self):
        self.assertAlmostEqual(scaled_jacobian(self.mesh).min(), 0.8016, delta=1e-4)

    def test_mesh_made_at_the_final_shape(self):
        final = Models.get("bore").hexahedra(bore.S_F)
        self.assertAlmostEqual(scaled_jacobian(final).min(), 0.5667, delta=1e-4)

    def test_moved_boundary_is_that_of_a_mesh_made_there(self):
        for t in (0.37, 1.0, 1.5):
            made = Models.get("bore").hexahedra(bore.S_0.toward(bore.S_F, t))
            difference = self.mesh.boundary_positions(t) - made.points[self.mesh.nodes]
            self.assertLess(np.abs(difference).max(), 1e-12)

    def test_faces_turn_with_the_countersink(self):
        # The cone's wall turns by 15 degrees, the others not at all.
        def normals(points):
            corners = points[self.mesh.faces]
            normal = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
            return normal / np.linalg.norm(normal, axis=1)[:, None]

        cosine = np.sum(normals(self.mesh.points) * normals(self.mesh.moved(1)), axis=1)
        cone = self.mesh.face_surface == bore.Surface.CONE
        self.assertAlmostEqual(cosine[cone].mean(), np.cos(np.radians(15)), delta=1e-3)
        self.assertGreater(cosine[~cone].min(), 1 - 1e-12)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
