# SPDX-License-Identifier: BSD-3-Clause
"""The canister: a cylinder with a hole along it that moves sideways.

One of the four models of Staten et al., IMR 2011 (see bore.py for the citation). One parameter, the
hole's offset from the axis; the motion is local and severe, most of the model does not change.

This is a reconstruction: neither geometry nor meshes were published. The proportions are chosen;
the paper's counts, 136,462 nodes and 128,269 hexahedra, are those of some 2,138 unstructured
quadrilaterals swept through 60 layers, and cells of one size then give the height.

At S_0 hole and cylinder have one axis. A node of a cap keeps its angle a and its fraction f of the
way from the hole to the rim:

    x = (1 - f) (offset e_x + hole radius e(a)) + f radius e(a),    e(a) = (cos a, sin a)

det dx / d(f, a) = |dx / da| (radius - hole radius - offset cos a): the map cannot fold while there
is a gap between hole and rim, and neither does it move the rim.
"""

from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from .columns import columns
from .model import Counts, Curve, Model, snapped
from .shape import Shape
from .structured import revolved
from .sweep import swept


@dataclass(frozen=True)
class CanisterShape(Shape):
    """Needs hole radius + |offset| < radius, and a height."""

    radius: float
    height: float
    hole_radius: float
    offset: float  #: of the hole's axis, along x

    def __post_init__(self):
        if not 0 < self.hole_radius < self.radius - abs(self.offset) or self.height <= 0:
            raise ValueError(f"the hole of a canister must be inside it: {self}")


S_0 = CanisterShape(radius=1.0, height=2.2, hole_radius=0.25, offset=0.0)
S_F = CanisterShape(radius=1.0, height=2.2, hole_radius=0.25, offset=0.5)


class Surface(IntEnum):
    HOLE = 0
    WALL = 1
    BOTTOM = 2
    TOP = 3


class Circle(IntEnum):
    """The curves."""

    HOLE_BOTTOM = 0
    HOLE_TOP = 1
    RIM_BOTTOM = 2
    RIM_TOP = 3


class Canister(Model):
    """A place is (f, zeta, angle): in [0, 1] from the hole to the wall, in [0, 1] from the bottom
    to the top, radians about the hole's axis (and the wall's: they are parallel)."""

    name = "canister"
    initial, final = S_0, S_F
    last = 1.45  # at 1.5 there is no gap left
    Surface = Surface
    curves = tuple(Curve((side, cap)) for side in (Surface.HOLE, Surface.WALL)
                   for cap in (Surface.BOTTOM, Surface.TOP))
    paper = {"hex": Counts(136462, 128269), "tet": Counts(83562, 472924)}

    def locate(self, points, tolerance=1e-9):
        """Tolerance: as a fraction of the radius."""
        shape = self.initial
        length = tolerance * shape.radius
        x, y, z = columns(points)
        radius, angle = np.hypot(x, y), np.arctan2(y, x)
        f = (radius - shape.hole_radius) / (shape.radius - shape.hole_radius)
        f, zeta = snapped(f, tolerance), snapped(z / shape.height, tolerance)
        angle[radius * np.abs(angle) <= length] = 0
        inside = (f >= 0) & (f <= 1) & (zeta >= 0) & (zeta <= 1)
        on = (f == 0) | (f == 1) | (zeta == 0) | (zeta == 1)
        if not np.all(inside & on):
            lost = np.flatnonzero(~(inside & on))
            raise ValueError(f"points {lost[:10]} are not on the surface: {shape}")
        return np.column_stack([f, zeta, angle])

    def positions(self, places, shape):
        f, zeta, angle = columns(places)
        radius = (1 - f) * shape.hole_radius + f * shape.radius
        shift = (1 - f) * shape.offset
        return np.column_stack(
            [shift + radius * np.cos(angle), radius * np.sin(angle), zeta * shape.height])

    def on_surfaces(self, places):
        f, zeta, _ = columns(places)
        return np.column_stack([f == 0, f == 1, zeta == 0, zeta == 1])

    def angles(self, places):
        return places[:, 2]

    def normals(self, surfaces, points, shape):
        axis = np.where(surfaces == Surface.HOLE, shape.offset, 0.0)
        x, y, _ = columns(points)
        angle = np.arctan2(y, x - axis)
        radial, upward = np.array([(-1, 0), (1, 0), (0, -1), (0, 1)])[surfaces].T
        return np.column_stack([radial * np.cos(angle), radial * np.sin(angle), upward])

    def volume(self, shape):
        return np.pi * (shape.radius**2 - shape.hole_radius**2) * shape.height

    def hex_mesh(self, small=False):
        """Unstructured quadrilaterals by Gmsh swept through 60 layers; small: structured, 48 cells
        around, 12 from hole to wall, 16 layers, without Gmsh."""
        shape = self.initial
        if small:
            radius = np.linspace(shape.hole_radius, shape.radius, 13)
            z = np.linspace(shape.height, 0, 17)
            profile = np.stack(np.broadcast_arrays(radius, z[:, None]), axis=-1)
            return self.classified(revolved(profile, 48))

        from .gmsh_mesh import quadrilaterals

        points, faces = quadrilaterals(self._build_section, 0.0409)
        layers = [60] * len(faces)
        return self.classified(swept(points, faces, layers, np.linspace(0, shape.height, 61)))

    def tet_mesh(self, small=False):
        from .gmsh_mesh import tetrahedra

        return self.classified(tetrahedra(self._build, 0.09 if small else 0.04))

    def _build_section(self, occ):
        disks = [occ.addDisk(0, 0, 0, radius, radius)
                 for radius in (self.initial.radius, self.initial.hole_radius)]
        return occ.cut([(2, disks[0])], [(2, disks[1])])[0]

    def _build(self, occ):
        occ.extrude(self._build_section(occ), 0, 0, self.initial.height)
