# SPDX-License-Identifier: BSD-3-Clause
"""The pipe: a 90-degree elbow between two straights.

One of the four models of Staten et al., IMR 2011 (see bore.py for the citation). Radius and
thickness decrease, the radius of the elbow increases.

This is a reconstruction: neither geometry nor meshes were published. The paper's counts of nodes
and cells, 11,520 and 8,532, are those of a structured mesh with 36 cells around, 3 through the wall
and 79 along; cells of one size, 2 pi / 36, then give the lengths at S_0. The final shape is chosen:
the paper tells which parameters grow and which shrink, not how much.

The center line starts at the origin, runs along z, turns towards x and ends along x. The circles
where straights and elbow join are curves of the model: the surfaces touch there without an edge.

    station 0 -- FIRST straight -- 1 -- ELBOW -- 2 -- SECOND straight -- 3
"""

from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from .columns import columns
from .model import Counts, Curve, Model, snapped
from .shape import Shape
from .structured import around_axis


@dataclass(frozen=True)
class PipeShape(Shape):
    """Needs 0 < thickness < outer radius < elbow radius and straights of some length."""

    outer_radius: float
    thickness: float
    elbow_radius: float  #: of the center line
    straight: float  #: length of each of the two straights

    def __post_init__(self):
        if not 0 < self.thickness < self.outer_radius < self.elbow_radius or self.straight <= 0:
            raise ValueError("a pipe needs 0 < thickness < outer radius < elbow radius, and"
                             f" straights: {self}")

    @property
    def inner_radius(self):
        return self.outer_radius - self.thickness


S_0 = PipeShape(outer_radius=1.25, thickness=0.5, elbow_radius=3.0, straight=4.54)
S_F = PipeShape(outer_radius=0.75, thickness=0.25, elbow_radius=6.0, straight=4.54)


class Surface(IntEnum):
    INNER_FIRST = 0
    INNER_ELBOW = 1
    INNER_SECOND = 2
    OUTER_FIRST = 3
    OUTER_ELBOW = 4
    OUTER_SECOND = 5
    FIRST_END = 6
    SECOND_END = 7


class Circle(IntEnum):
    """The curves: INNER and OUTER with their station."""

    INNER_0 = 0
    INNER_1 = 1
    INNER_2 = 2
    INNER_3 = 3
    OUTER_0 = 4
    OUTER_1 = 5
    OUTER_2 = 6
    OUTER_3 = 7


_CURVES = tuple(Curve(surfaces) for surfaces in (
    (Surface.INNER_FIRST, Surface.FIRST_END),
    (Surface.INNER_FIRST, Surface.INNER_ELBOW),
    (Surface.INNER_ELBOW, Surface.INNER_SECOND),
    (Surface.INNER_SECOND, Surface.SECOND_END),
    (Surface.OUTER_FIRST, Surface.FIRST_END),
    (Surface.OUTER_FIRST, Surface.OUTER_ELBOW),
    (Surface.OUTER_ELBOW, Surface.OUTER_SECOND),
    (Surface.OUTER_SECOND, Surface.SECOND_END),
))


def _center_line(station, shape):
    """Points (n, 3) and turning angles phi (n,), 0 along z and pi / 2 along x."""
    first = np.minimum(station, 1) * shape.straight
    phi = np.clip(station - 1, 0, 1) * (np.pi / 2)
    second = np.maximum(station - 2, 0) * shape.straight
    elbow = shape.elbow_radius
    x = elbow * (1 - np.cos(phi)) + second
    z = first + elbow * np.sin(phi)
    return np.column_stack([x, np.zeros_like(x), z]), phi


def _unbent(points, shape):
    """station, u, y of points: u towards the elbow's center and y across the center line."""
    x, y, z = columns(points)
    straight, elbow = shape.straight, shape.elbow_radius
    along, aside = z - straight, elbow - x
    phi = np.arctan2(along, aside)
    u = elbow - np.hypot(along, aside)
    station = 1 + phi / (np.pi / 2)
    first, second = along <= 0, (aside <= 0) & (along > 0)
    station[first], u[first] = z[first] / straight, x[first]
    station[second], u[second] = 2 - aside[second] / straight, elbow - along[second]
    return station, u, y


class Pipe(Model):
    """A place is (station, depth, angle): in [0, 3] along the center line, in [0, 1] from the inner
    wall to the outer, radians about the center line from the elbow's inside."""

    name = "pipe"
    initial, final = S_0, S_F
    last = 1.95  # at 2 the wall has no thickness left
    Surface = Surface
    curves = _CURVES
    paper = {"hex": Counts(11520, 8532), "tet": Counts(17174, 81304)}

    def locate(self, points, tolerance=1e-9):
        """Tolerance: as a fraction of the elbow's radius."""
        shape = self.initial
        length = tolerance * shape.elbow_radius
        station, u, y = _unbent(points, shape)
        radius, angle = np.hypot(u, y), np.arctan2(y, u)
        depth = (radius - shape.inner_radius) / shape.thickness
        station = snapped(station, length / shape.straight)
        depth = snapped(depth, length / shape.thickness)
        angle[radius * np.abs(angle) <= length] = 0
        inside = (station >= 0) & (station <= 3) & (depth >= 0) & (depth <= 1)
        on = (depth == 0) | (depth == 1) | (station == 0) | (station == 3)
        if not np.all(inside & on):
            lost = np.flatnonzero(~(inside & on))
            raise ValueError(f"points {lost[:10]} are not on the surface: {shape}")
        return np.column_stack([station, depth, angle])

    def positions(self, places, shape):
        station, depth, angle = columns(places)
        center, phi = _center_line(station, shape)
        radius = (1 - depth) * shape.inner_radius + depth * shape.outer_radius
        u, v = radius * np.cos(angle), radius * np.sin(angle)
        return center + np.column_stack([u * np.cos(phi), v, -u * np.sin(phi)])

    def on_surfaces(self, places):
        station, depth, _ = columns(places)
        parts = [(station >= part) & (station <= part + 1) for part in range(3)]
        walls = [part & (depth == side) for side in (0, 1) for part in parts]
        return np.column_stack([*walls, station == 0, station == 3])

    def angles(self, places):
        return places[:, 2]

    def normals(self, surfaces, points, shape):
        station, u, y = _unbent(points, shape)
        phi = np.clip(station - 1, 0, 1) * (np.pi / 2)
        radial = np.column_stack([u * np.cos(phi), y, -u * np.sin(phi)])
        radial /= np.hypot(u, y)[:, None]
        normal = np.where(surfaces[:, None] < Surface.OUTER_FIRST, -radial, radial)
        normal[surfaces == Surface.FIRST_END] = (0, 0, -1)
        normal[surfaces == Surface.SECOND_END] = (1, 0, 0)
        return normal

    def volume(self, shape):
        # Pappus: the section's centroid is on the center line.
        length = 2 * shape.straight + np.pi / 2 * shape.elbow_radius
        return np.pi * (shape.outer_radius**2 - shape.inner_radius**2) * length

    def hex_mesh(self, small=False):
        """Structured: 36 cells around, 3 through the wall, 26 + 27 + 26 along; small: 24, 2 and 13
        on each part."""
        around, through, parts = (24, 2, (13, 13, 13)) if small else (36, 3, (26, 27, 26))
        station = np.concatenate([
            number + np.arange(cells) / cells for number, cells in enumerate(parts)] + [[3.0]])
        grid = np.meshgrid(
            # from the far end backwards: see around_axis
            station[::-1], np.arange(through + 1) / through,
            2 * np.pi * np.arange(around) / around, indexing="ij")
        places = np.stack(grid, axis=-1)
        points = self.positions(places.reshape(-1, 3), self.initial)
        return self.classified(around_axis(points.reshape(places.shape)))

    def tet_mesh(self, small=False):
        from .gmsh_mesh import tetrahedra

        return self.classified(tetrahedra(self._build, 0.27 if small else 0.1415))

    def _build(self, occ):
        shape = self.initial
        loops = []
        for radius in (shape.outer_radius, shape.inner_radius):
            loops.append(occ.addCurveLoop([occ.addCircle(0, 0, 0, radius)]))
        end = [(2, occ.addPlaneSurface(loops))]
        # The first entity that a sweep returns is the face it ends at.
        joint = occ.extrude(end, 0, 0, shape.straight)[:1]
        joint = occ.revolve(joint, shape.elbow_radius, 0, shape.straight, 0, 1, 0, np.pi / 2)[:1]
        occ.extrude(joint, shape.straight, 0, 0)
