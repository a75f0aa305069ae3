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

Table 1 of the paper prints the hexahedral mesh as 11,904 nodes and 15,190 cells. Those two are
swapped: a structured mesh of this solid has more nodes than cells, and the numbers the other way
round have exactly one solution, 62 cells around, 4 through the wall and 48 along. Then all cells
are close to cubes of side 0.25. Which mesher made the paper's tetrahedral mesh, 21,859 nodes and
109,535 cells, is not known.
"""

from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from .columns import columns
from .model import Counts, Curve, Model
from .shape import Shape
from .structured import revolved


@dataclass(frozen=True)
class BoreShape(Shape):
    """Needs 0 < r1 < r2 < r3, 0 < theta < 180 and a countersink that ends above the foot."""

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


#: The initial and the final shape as the paper prints them.
S_0 = BoreShape(12.0, 2.0, 2.5, 3.0, 60.0)
S_F = BoreShape(12.0, 2.5, 3.5, 6.0, 30.0)


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

#: (#circles, 2) the surfaces that meet in a circle
CIRCLE_SURFACES = tuple(
    tuple(surface for surface in Surface if circle in SURFACE_CIRCLES[surface])
    for circle in Circle)


def circle_profile(shape):
    """(#circles, 2): radius and height z of each circle."""
    return np.array([
        (shape.mouth_radius, shape.height),
        (shape.bore_radius, shape.height - shape.cone_depth),
        (shape.bore_radius, 0.0),
        (shape.outer_radius, shape.height),
        (shape.outer_radius, 0.0),
    ])


class Bore(Model):
    """A place is (surface, along, angle): a Surface the node is on, in [0, 1] how far along its
    profile line from its first circle to its second, radians about z."""

    name = "bore"
    initial, final = S_0, S_F
    last = 1.55  # at 1.59 the countersink reaches the foot
    Surface = Surface
    curves = tuple(Curve(surfaces) for surfaces in CIRCLE_SURFACES)
    paper = {"hex": Counts(15190, 11904), "tet": Counts(21859, 109535)}

    def locate(self, points, tolerance=1e-9):
        """Tolerance: as a fraction of the height."""
        length = tolerance * self.initial.height
        x, y, z = columns(points)
        radius = np.hypot(x, y)
        flat = np.column_stack([radius, z])
        profile = circle_profile(self.initial)

        start, end = profile[SURFACE_CIRCLES[:, 0]], profile[SURFACE_CIRCLES[:, 1]]
        line = end - start
        along = np.einsum("nsk,sk->ns", flat[:, None] - start, line) / np.sum(line**2, axis=1)
        along = np.clip(along, 0.0, 1.0)
        distance = np.linalg.norm(start + along[..., None] * line - flat[:, None], axis=2)
        surface = np.argmin(distance, axis=1)
        nodes = np.arange(len(points))
        lost = ~(distance[nodes, surface] <= length)
        if np.any(lost):
            raise ValueError(f"points {np.flatnonzero(lost)[:10]} are not on the surface:"
                             f" {self.initial}")

        along = along[nodes, surface]
        on_circle = np.linalg.norm(flat[:, None] - profile, axis=2).min(axis=1) <= length
        along[on_circle] = np.round(along[on_circle])
        angle = np.arctan2(y, x)
        angle[on_circle & (radius * np.abs(angle) <= length)] = 0
        return np.column_stack([surface, along, angle])

    def positions(self, places, shape):
        surface, along, angle = columns(places)
        first, second = circle_profile(shape)[SURFACE_CIRCLES[surface.astype(int)].T]
        radius, z = (1 - along) * first.T + along * second.T
        return np.column_stack([radius * np.cos(angle), radius * np.sin(angle), z])

    def on_surfaces(self, places):
        surface, along = places[:, 0].astype(int), places[:, 1]
        on = surface[:, None] == np.arange(len(Surface))
        for end in (0, 1):
            nodes = np.flatnonzero(along == end)
            circles = SURFACE_CIRCLES[surface[nodes], end]
            for surfaces in np.array(CIRCLE_SURFACES)[circles].T:
                on[nodes, surfaces] = True
        return on

    def angles(self, places):
        return places[:, 2]

    def normals(self, surfaces, points, shape):
        half = np.radians(shape.cone_angle) / 2
        radial, upward = np.array([
            (-np.cos(half), np.sin(half)), (-1, 0), (1, 0), (0, 1), (0, -1)])[surfaces].T
        x, y, _ = columns(points)
        angle = np.arctan2(y, x)
        return np.column_stack([radial * np.cos(angle), radial * np.sin(angle), upward])

    def volume(self, shape):
        inner, mouth, depth = shape.bore_radius, shape.mouth_radius, shape.cone_depth
        cut = inner**2 * (shape.height - depth) + depth * (mouth**2 + mouth * inner + inner**2) / 3
        return np.pi * (shape.outer_radius**2 * shape.height - cut)

    def hex_mesh(self, small=False):
        """Structured: 62 cells around, 4 through the wall and 48 along; small: 32, 2 and 24."""
        return self.classified(self.hexahedra(self.initial, small))

    def hexahedra(self, shape, small=False):
        """The structured ModelMesh of any shape, for comparison with a morphed one. Nodes are
        equally spaced on each inner profile line and on the whole outer one; straight lines join
        inner to outer."""
        around, through, along_cone, along_bore = (32, 2, 2, 22) if small else (62, 4, 3, 45)
        profile = circle_profile(shape)

        def line(surface, v):
            first, second = profile[SURFACE_CIRCLES[surface]]
            return first + v[:, None] * (second - first)

        along = along_cone + along_bore
        inner = np.concatenate([
            line(Surface.CONE, np.arange(along_cone) / along_cone),
            line(Surface.BORE, np.arange(along_bore + 1) / along_bore),
        ])
        outer = line(Surface.OUTER, np.arange(along + 1) / along)
        v = (np.arange(through + 1) / through)[:, None]
        flat = (1 - v) * inner[:, None] + v * outer[:, None]  # layer, ring, (r, z)
        return revolved(flat, around)

    def tet_mesh(self, small=False):
        from .gmsh_mesh import tetrahedra

        return self.classified(tetrahedra(self._build, 0.42 if small else 0.203))

    def _build(self, occ):
        corners = [occ.addPoint(r, 0, z) for r, z in circle_profile(self.initial)]
        lines = [occ.addLine(corners[a], corners[b]) for a, b in SURFACE_CIRCLES]
        loop = [Surface.CONE, Surface.BORE, Surface.FOOT_END, Surface.OUTER, Surface.TOP_END]
        section = occ.addPlaneSurface([occ.addCurveLoop([lines[side] for side in loop])])
        occ.revolve([(2, section)], 0, 0, 0, 0, 0, 1, 2 * np.pi)
        occ.remove([(2, section)], recursive=True)
