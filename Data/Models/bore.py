# SPDX-License-Identifier: BSD-3-Clause
"""The bore: a tube with a countersink at its upper end.

One of the four models of M. L. Staten, S. J. Owen, S. M. Shontz, A. G. Salinger and T. S. Coffey,
"A Comparison of Mesh Morphing Methods for 3D Shape Optimization", Proceedings of the 20th
International Meshing Roundtable (2011). It tests scaling and rotation: all radii grow and the wall
of the countersink turns.

This is a reconstruction. Neither the geometry nor the meshes were published; what is here fits
every number the paper prints: the parameters of the initial shape S_0 and of the final shape S_F,
and the counts of nodes and cells (those of the tetrahedra, which depend on the mesher, to 6 %).

The solid is the full revolution about z of a pentagon in the (r, z) half plane, so every boundary
surface is the revolution of a straight line (a cone, two cylinders, two annuli), and a boundary
node is given by its surface, its place along the line and its angle. Those stay fixed while the
parameters change; hence boundary positions of any shape between S_0 and S_F are evaluated exactly,
by formula.

         z
         h |   MOUTH .------. OUTER_TOP
           |        /       |
           |       /        |     radii: MOUTH r2, THROAT and FOOT r1, both OUTER r3
           |      | THROAT  |     THROAT at z = h - (r2 - r1) / tan(theta / 2)
           |      |         |
         0 |------'---------'---- r
                 FOOT   OUTER_FOOT
"""

from dataclasses import astuple, dataclass
from enum import IntEnum

import numpy as np


@dataclass(frozen=True)
class BoreParameters:
    """Lengths in the model's unit. Raises ValueError for numbers that make no bore: needs 0 < r1 <
    r2 < r3, 0 < theta < 180 and a countersink that ends above the foot."""

    height: float  #: h
    bore_radius: float  #: r1
    mouth_radius: float  #: r2, of the countersink at the upper end
    outer_radius: float  #: r3
    cone_angle: float  #: theta, the countersink's included angle in degrees

    def __post_init__(self):
        if not 0 < self.bore_radius < self.mouth_radius < self.outer_radius:
            raise ValueError(f"the radii of a bore must grow from bore to mouth to outside: {self}")
        if not 0 < self.cone_angle < 180 or not 0 < self.cone_depth < self.height:
            raise ValueError(f"the countersink of a bore must end above its foot: {self}")

    @property
    def cone_depth(self):
        """How far the countersink reaches down from the upper end."""
        slope = np.tan(np.radians(self.cone_angle) / 2)
        return (self.mouth_radius - self.bore_radius) / slope

    def toward(self, final, t):
        """S_t = S_0 + t (S_F - S_0), each parameter by itself. `t` may leave [0, 1] while the shape
        stays a bore."""
        return BoreParameters(*(a + t * (b - a) for a, b in zip(astuple(self), astuple(final))))


#: The initial and the final shape as the paper prints them.
S_0 = BoreParameters(12.0, 2.0, 2.5, 3.0, 60.0)
S_F = BoreParameters(12.0, 2.5, 3.5, 6.0, 30.0)


class Circle(IntEnum):
    """The corners of the revolved pentagon: the model's curves."""

    MOUTH = 0
    THROAT = 1
    FOOT = 2
    OUTER_TOP = 3
    OUTER_FOOT = 4


class Surface(IntEnum):
    """The sides of the revolved pentagon: the model's surfaces."""

    CONE = 0
    BORE = 1
    OUTER = 2
    TOP_END = 3
    FOOT_END = 4


#: (#surfaces, 2) the circles a surface starts and ends at
SURFACE_CIRCLES = np.array([
    (Circle.MOUTH, Circle.THROAT),
    (Circle.THROAT, Circle.FOOT),
    (Circle.OUTER_TOP, Circle.OUTER_FOOT),
    (Circle.MOUTH, Circle.OUTER_TOP),
    (Circle.FOOT, Circle.OUTER_FOOT),
])


def circle_profile(parameters):
    """(#circles, 2): radius and height z of each circle."""
    p = parameters
    return np.array([
        (p.mouth_radius, p.height),
        (p.bore_radius, p.height - p.cone_depth),
        (p.bore_radius, 0.0),
        (p.outer_radius, p.height),
        (p.outer_radius, 0.0),
    ])


@dataclass
class BoundaryPlaces:
    """Where boundary nodes sit on the model, independent of its parameters; all arrays have one
    entry per node.

    dimension: 0 on a vertex, 1 on a curve, 2 inside a surface. A circle has one vertex, at angle 0.
    entity: the Circle of a vertex or curve, the Surface otherwise.
    surface: a Surface the node lies on (for nodes on a circle, one of the two).
    along: in [0, 1], place on the surface's profile line from its first circle to its second.
    angle: radians about z.
    """

    dimension: np.ndarray
    entity: np.ndarray
    surface: np.ndarray
    along: np.ndarray
    angle: np.ndarray

    def positions(self, parameters):
        """(#nodes, 3): the exact positions on the bore of these parameters."""
        profile = circle_profile(parameters)
        first, second = profile[SURFACE_CIRCLES[self.surface].T]
        along = self.along[:, None]
        radius, z = ((1 - along) * first + along * second).T
        return np.column_stack([radius * np.cos(self.angle), radius * np.sin(self.angle), z])


def locate(parameters, points, tolerance=1e-9):
    """The places of boundary `points` (n, 3) on the bore of `parameters`: the inverse of
    BoundaryPlaces.positions. Raises ValueError for a point further than `tolerance` times the
    height from every surface."""
    length = tolerance * parameters.height
    radius = np.hypot(points[:, 0], points[:, 1])
    flat = np.column_stack([radius, points[:, 2]])
    profile = circle_profile(parameters)

    start, end = profile[SURFACE_CIRCLES[:, 0]], profile[SURFACE_CIRCLES[:, 1]]
    line = end - start
    along = np.einsum("nsk,sk->ns", flat[:, None] - start, line) / np.sum(line**2, axis=1)
    along = np.clip(along, 0.0, 1.0)
    distance = np.linalg.norm(start + along[..., None] * line - flat[:, None], axis=2)
    surface = np.argmin(distance, axis=1)
    nodes = np.arange(len(points))
    lost = distance[nodes, surface] > length
    if np.any(lost):
        raise ValueError(f"points {np.flatnonzero(lost)[:10]} are not on the surface: {parameters}")

    to_circle = np.linalg.norm(flat[:, None] - profile, axis=2)
    circle = np.argmin(to_circle, axis=1)
    on_circle = to_circle[nodes, circle] <= length
    angle = np.arctan2(points[:, 1], points[:, 0])
    on_vertex = on_circle & (radius * np.abs(angle) <= length)

    along = along[nodes, surface]
    along[on_circle] = np.round(along[on_circle])
    dimension = np.where(on_vertex, 0, np.where(on_circle, 1, 2))
    return BoundaryPlaces(dimension, np.where(on_circle, circle, surface), surface, along, angle)
