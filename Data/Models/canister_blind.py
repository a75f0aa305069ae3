# SPDX-License-Identifier: BSD-3-Clause
"""The canister with a blind hole: a variant, in which the hole ends a quarter of the height above
the bottom. Bottom and wall do not move at all."""

from enum import IntEnum

import numpy as np

from .canister import Canister
from .columns import columns
from .model import Curve, snapped
from .sweep import swept

FLOOR = 0.25  #: height of the hole's floor as a fraction of the canister's


class Surface(IntEnum):
    HOLE = 0
    WALL = 1
    BOTTOM = 2
    TOP = 3
    FLOOR = 4


class CanisterBlind(Canister):
    """A place is (f, zeta, angle) as the canister's; under the hole f is in [-1, 0] from the axis
    to the hole's wall."""

    name = "canister_blind"
    Surface = Surface
    curves = (Curve((Surface.HOLE, Surface.FLOOR)), Curve((Surface.HOLE, Surface.TOP)),
              Curve((Surface.WALL, Surface.BOTTOM)), Curve((Surface.WALL, Surface.TOP)))

    def locate(self, points, tolerance=1e-9):
        shape = self.initial
        length = tolerance * shape.radius
        x, y, z = columns(points)
        radius, angle = np.hypot(x, y), np.arctan2(y, x)
        beyond = radius - shape.hole_radius
        f = beyond / np.where(beyond < 0, shape.hole_radius, shape.radius - shape.hole_radius)
        f = snapped(f, length / shape.hole_radius)
        zeta = snapped(z / shape.height, tolerance)
        zeta[np.abs(z - FLOOR * shape.height) <= length] = FLOOR
        angle[radius * np.abs(angle) <= length] = 0
        places = np.column_stack([f, zeta, angle])
        on = self.on_surfaces(places).any(axis=1)
        if not np.all(on):
            raise ValueError(f"points {np.flatnonzero(~on)[:10]} are not on the surface: {shape}")
        return places

    def positions(self, places, shape):
        f, zeta, angle = columns(places)
        outside = np.maximum(f, 0)
        radius = ((1 - outside) * shape.hole_radius + outside * shape.radius
                  + np.minimum(f, 0) * shape.hole_radius)
        shift = np.where(zeta == 0, 0, (1 - outside) * shape.offset)
        return np.column_stack(
            [shift + radius * np.cos(angle), radius * np.sin(angle), zeta * shape.height])

    def on_surfaces(self, places):
        f, zeta, _ = columns(places)
        inside = (f >= -1) & (f <= 1) & (zeta >= 0) & (zeta <= 1)
        return inside[:, None] & np.column_stack([
            (f == 0) & (zeta >= FLOOR), f == 1, zeta == 0, (zeta == 1) & (f >= 0),
            (zeta == FLOOR) & (f <= 0)])

    def normals(self, surfaces, points, shape):
        upward = np.where(surfaces == Surface.FLOOR, Surface.TOP, surfaces)
        return super().normals(upward, points, shape)

    def volume(self, shape):
        return super().volume(shape) + np.pi * shape.hole_radius**2 * FLOOR * shape.height

    def hex_mesh(self, small=False):
        """Unstructured quadrilaterals by Gmsh swept through 60 layers, 15 under the hole; small: 16
        and 4."""
        from .gmsh_mesh import quadrilaterals

        size, high = (0.1, 16) if small else (0.0409, 60)
        points, faces = quadrilaterals(self._build_section, size)
        radius = [np.linalg.norm(points[quads], axis=2).max() for quads in faces]
        hole = self.initial.hole_radius
        layers = [int(FLOOR * high) if r < (1 + 1e-9) * hole else high for r in radius]
        return self.classified(
            swept(points, faces, layers, np.linspace(0, self.initial.height, high + 1)))

    def _build_section(self, occ):
        disks = [(2, occ.addDisk(0, 0, 0, radius, radius))
                 for radius in (self.initial.radius, self.initial.hole_radius)]
        occ.fragment(disks[:1], disks[1:])

    def _build(self, occ):
        shape = self.initial
        floor = FLOOR * shape.height
        wall = (3, occ.addCylinder(0, 0, 0, 0, 0, shape.height, shape.radius))
        hole = (3, occ.addCylinder(0, 0, floor, 0, 0, shape.height - floor, shape.hole_radius))
        occ.cut([wall], [hole])
