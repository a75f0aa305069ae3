# SPDX-License-Identifier: BSD-3-Clause
"""The bore read in another way: a variant, for what the paper's angle theta may have meant.

The paper prints the bore's parameters h, r1, r2, r3 and theta and says that the model tests scaling
and rotations, but not what they measure. Here r1 is the radius of a straight hole, the outer wall
is a cone from r2 at the foot to r3 at the top, and the solid is twisted about its axis, by 0 at the
foot to theta at the top. The walls are surfaces of revolution, so the twist moves nodes within
them: from S_0 to S_F the top turns back by 30 degrees. The counts of the structured mesh are the
paper's here too.
"""

from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from .columns import columns
from .model import Counts, Curve, Model, snapped
from .shape import Shape
from .structured import revolved


@dataclass(frozen=True)
class BoreTwistShape(Shape):
    """Needs 0 < r1 < r2, r1 < r3, and a height."""

    height: float  #: h
    bore_radius: float  #: r1
    foot_radius: float  #: r2, outside
    top_radius: float  #: r3, outside
    twist: float  #: theta, of the top against the foot, degrees

    def __post_init__(self):
        if not 0 < self.bore_radius < min(self.foot_radius, self.top_radius) or self.height <= 0:
            raise ValueError(f"a twisted bore needs its hole inside the outer wall: {self}")


S_0 = BoreTwistShape(12.0, 2.0, 2.5, 3.0, 60.0)
S_F = BoreTwistShape(12.0, 2.5, 3.5, 6.0, 30.0)


class Surface(IntEnum):
    BORE = 0
    OUTER = 1
    FOOT_END = 2
    TOP_END = 3


class BoreTwist(Model):
    """A place is (depth, rise, angle): in [0, 1] from the bore to the outer wall, in [0, 1] from
    foot to top, radians about z at S_0."""

    name = "bore_twist"
    initial, final = S_0, S_F
    last = 2.0  # there the twist is gone; the geometry goes on
    Surface = Surface
    curves = tuple(Curve((side, end)) for side in (Surface.BORE, Surface.OUTER)
                   for end in (Surface.FOOT_END, Surface.TOP_END))
    paper = {"hex": Counts(15190, 11904), "tet": Counts(21859, 109535)}

    def locate(self, points, tolerance=1e-9):
        """Tolerance: as a fraction of the height."""
        shape = self.initial
        length = tolerance * shape.height
        x, y, z = columns(points)
        radius, angle = np.hypot(x, y), np.arctan2(y, x)
        rise = snapped(z / shape.height, tolerance)
        depth = (radius - shape.bore_radius) / (self._outer(rise, shape) - shape.bore_radius)
        depth = snapped(depth, length / (shape.foot_radius - shape.bore_radius))
        angle[radius * np.abs(angle) <= length] = 0
        inside = (depth >= 0) & (depth <= 1) & (rise >= 0) & (rise <= 1)
        on = (depth == 0) | (depth == 1) | (rise == 0) | (rise == 1)
        if not np.all(inside & on):
            lost = np.flatnonzero(~(inside & on))
            raise ValueError(f"points {lost[:10]} are not on the surface: {shape}")
        return np.column_stack([depth, rise, angle])

    @staticmethod
    def _outer(rise, shape):
        return (1 - rise) * shape.foot_radius + rise * shape.top_radius

    def positions(self, places, shape):
        depth, rise, angle = columns(places)
        angle = angle + np.radians(shape.twist - self.initial.twist) * rise
        radius = (1 - depth) * shape.bore_radius + depth * self._outer(rise, shape)
        return np.column_stack(
            [radius * np.cos(angle), radius * np.sin(angle), rise * shape.height])

    def on_surfaces(self, places):
        depth, rise, _ = columns(places)
        return np.column_stack([depth == 0, depth == 1, rise == 0, rise == 1])

    def angles(self, places):
        return places[:, 2]

    def normals(self, surfaces, points, shape):
        slope = np.arctan2(shape.top_radius - shape.foot_radius, shape.height)
        radial, upward = np.array([
            (-1, 0), (np.cos(slope), -np.sin(slope)), (0, -1), (0, 1)])[surfaces].T
        x, y, _ = columns(points)
        angle = np.arctan2(y, x)
        return np.column_stack([radial * np.cos(angle), radial * np.sin(angle), upward])

    def volume(self, shape):
        foot, top = shape.foot_radius, shape.top_radius
        mean_square = (foot**2 + foot * top + top**2) / 3
        return np.pi * shape.height * (mean_square - shape.bore_radius**2)

    def hex_mesh(self, small=False):
        """Structured: 62 cells around, 4 through the wall and 48 along; small: 32, 2 and 24."""
        around, through, along = (32, 2, 24) if small else (62, 4, 48)
        shape = self.initial
        rise = np.linspace(1, 0, along + 1)[:, None]
        depth = np.linspace(0, 1, through + 1)
        radius = (1 - depth) * shape.bore_radius + depth * self._outer(rise, shape)
        profile = np.stack(np.broadcast_arrays(radius, rise * shape.height), axis=-1)
        return self.classified(revolved(profile, around))

    def tet_mesh(self, small=False):
        from .gmsh_mesh import tetrahedra

        return self.classified(tetrahedra(self._build, 0.42 if small else 0.1865))

    def _build(self, occ):
        shape = self.initial
        corners = [occ.addPoint(r, 0, z) for r, z in (
            (shape.bore_radius, 0), (shape.foot_radius, 0), (shape.top_radius, shape.height),
            (shape.bore_radius, shape.height))]
        lines = [occ.addLine(a, b) for a, b in zip(corners, corners[1:] + corners[:1])]
        section = occ.addPlaneSurface([occ.addCurveLoop(lines)])
        occ.revolve([(2, section)], 0, 0, 0, 0, 0, 1, 2 * np.pi)
        occ.remove([(2, section)], recursive=True)
