# SPDX-License-Identifier: BSD-3-Clause
"""The courier-like model: a base plate with two bored bosses, and between them a rib with a slot.

For the courier of Staten et al., IMR 2011 (see bore.py for the citation), of which is known: a
thin part with eight parameters that change all at once, 101,817 nodes and 83,934 hexahedra swept in
parts from unstructured quadrilaterals, 136,106 nodes and 699,867 tetrahedra. The geometry was never
published and its parts were not named. What is here is a part of that kind and size, no more:
5 layers of 14,000 cells and 12 more layers over 1,160 of them give the counts.

    from above                                      from the side
    +------------------------------------+            _          _____          _
    |     .-.                    .-.     |          _| |________|     |________| |_
    |    ( o )    +--------+    ( o )    |         |_______________________________|
    |     '-'     |  slot  |     '-'     |
    |             +--------+             |
    +------------------------------------+

The bores go through plate and bosses; the slot ends at the plate's upper face. Every surface is
plane or a cylinder along z. In the plane nodes move by the map in footprint.py, upward by fractions
of the plate's thickness and of the bosses' height, which is the rib's too.
"""

from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from . import footprint
from .footprint import BACK, BOSSES, FRONT, GRID, LEFT, RIB_X, RIB_Y, RIGHT, SLOT_X, SLOT_Y
from .model import Counts, Curve, Model, snapped
from .shape import Shape
from .sweep import swept


@dataclass(frozen=True)
class CourierShape(Shape):
    """The eight parameters. Needs bore < boss, and bosses and rib apart from each other and inside
    the plate."""

    length: float  #: of the plate, along x
    width: float  #: of the plate, along y
    plate_thickness: float
    boss_radius: float
    bore_radius: float
    boss_height: float  #: above the plate; the rib's too
    boss_spacing: float  #: between the bosses' axes, along x
    rib_thickness: float  #: along y

    def __post_init__(self):
        x, y = footprint.lines(self)
        if (not 0 < self.bore_radius < self.boss_radius or self.plate_thickness <= 0
                or self.boss_height <= 0 or np.any(np.diff(x) <= 0) or np.any(np.diff(y) <= 0)):
            raise ValueError("a courier needs bore < boss, and bosses and rib apart from each other"
                             f" and inside the plate: {self}")

    @property
    def rib_length(self):
        return 0.4 * self.boss_spacing

    @property
    def slot_length(self):
        return 0.7 * self.rib_length

    @property
    def slot_width(self):
        return 0.4 * self.rib_thickness

    @property
    def square(self):
        """Side of the square around a boss inside which the map is radial. As the rib's length it
        follows the spacing: then lengths along x between the bosses all change alike."""
        return 0.48 * self.boss_spacing


S_0 = CourierShape(length=16.0, width=9.0, plate_thickness=0.5, boss_radius=1.3, bore_radius=0.6,
                   boss_height=1.2, boss_spacing=8.0, rib_thickness=1.4)
S_F = CourierShape(length=19.2, width=7.2, plate_thickness=0.65, boss_radius=1.04,
                   bore_radius=0.72, boss_height=0.96, boss_spacing=9.2, rib_thickness=1.75)


class Surface(IntEnum):
    PLATE_BOTTOM = 0
    PLATE_TOP = 1
    PLATE_LEFT = 2
    PLATE_RIGHT = 3
    PLATE_FRONT = 4
    PLATE_BACK = 5
    LEFT_BORE = 6
    LEFT_BOSS_WALL = 7
    LEFT_BOSS_TOP = 8
    RIGHT_BORE = 9
    RIGHT_BOSS_WALL = 10
    RIGHT_BOSS_TOP = 11
    RIB_LEFT = 12
    RIB_RIGHT = 13
    RIB_FRONT = 14
    RIB_BACK = 15
    RIB_TOP = 16
    SLOT_LEFT = 17
    SLOT_RIGHT = 18
    SLOT_FRONT = 19
    SLOT_BACK = 20
    SLOT_FLOOR = 21


S = Surface
#: The prismatic parts: four sides, around, and what they end at.
_PRISMS = (
    ((S.PLATE_LEFT, S.PLATE_FRONT, S.PLATE_RIGHT, S.PLATE_BACK), (S.PLATE_BOTTOM, S.PLATE_TOP)),
    ((S.RIB_LEFT, S.RIB_FRONT, S.RIB_RIGHT, S.RIB_BACK), (S.PLATE_TOP, S.RIB_TOP)),
    ((S.SLOT_LEFT, S.SLOT_FRONT, S.SLOT_RIGHT, S.SLOT_BACK), (S.SLOT_FLOOR, S.RIB_TOP)),
)


def _prism_curves():
    for sides, ends in _PRISMS:
        for side, following in zip(sides, sides[1:] + sides[:1]):
            yield Curve((side, following), closed=False)
            for end in ends:
                yield Curve((side, end), closed=False)


def _prism_corners():
    for sides, ends in _PRISMS:
        for side, following in zip(sides, sides[1:] + sides[:1]):
            for end in ends:
                yield (side, following, end)


_CIRCLES = (
    Curve((S.LEFT_BORE, S.PLATE_BOTTOM)),
    Curve((S.LEFT_BORE, S.LEFT_BOSS_TOP)),
    Curve((S.LEFT_BOSS_WALL, S.PLATE_TOP)),
    Curve((S.LEFT_BOSS_WALL, S.LEFT_BOSS_TOP)),
    Curve((S.RIGHT_BORE, S.PLATE_BOTTOM)),
    Curve((S.RIGHT_BORE, S.RIGHT_BOSS_TOP)),
    Curve((S.RIGHT_BOSS_WALL, S.PLATE_TOP)),
    Curve((S.RIGHT_BOSS_WALL, S.RIGHT_BOSS_TOP)),
)

_PLANES = {
    S.PLATE_BOTTOM: (0, 0, -1), S.PLATE_TOP: (0, 0, 1), S.PLATE_LEFT: (-1, 0, 0),
    S.PLATE_RIGHT: (1, 0, 0), S.PLATE_FRONT: (0, -1, 0), S.PLATE_BACK: (0, 1, 0),
    S.LEFT_BOSS_TOP: (0, 0, 1), S.RIGHT_BOSS_TOP: (0, 0, 1), S.RIB_LEFT: (-1, 0, 0),
    S.RIB_RIGHT: (1, 0, 0), S.RIB_FRONT: (0, -1, 0), S.RIB_BACK: (0, 1, 0), S.RIB_TOP: (0, 0, 1),
    S.SLOT_LEFT: (1, 0, 0), S.SLOT_RIGHT: (-1, 0, 0), S.SLOT_FRONT: (0, 1, 0),
    S.SLOT_BACK: (0, -1, 0), S.SLOT_FLOOR: (0, 0, 1),
}
_CYLINDERS = {S.LEFT_BORE: (-1, -1), S.LEFT_BOSS_WALL: (-1, 1), S.RIGHT_BORE: (1, -1),
              S.RIGHT_BOSS_WALL: (1, 1)}  #: side of the axis along x, normal outward or inward


class Courier(Model):
    """A place is (part, first, second, level): three coordinates in the footprint (see there), and
    in [0, 1] up through the plate, in [1, 2] through bosses and rib."""

    name = "courier"
    initial, final = S_0, S_F
    last = 1.6  # at 1.84 bores and bosses have one radius
    Surface = Surface
    curves = (*_prism_curves(), *_CIRCLES)
    corners = tuple(_prism_corners())
    paper = {"hex": Counts(101817, 83934), "tet": Counts(136106, 699867)}

    def locate(self, points, tolerance=1e-9):
        """Tolerance: as a fraction of the plate's length."""
        shape = self.initial
        length = tolerance * shape.length
        z = points[:, 2]
        level = np.where(z <= shape.plate_thickness, z / shape.plate_thickness,
                         1 + (z - shape.plate_thickness) / shape.boss_height)
        level = snapped(level, length / shape.plate_thickness)
        places = np.column_stack([footprint.locate(points[:, :2], shape, length), level])
        on = self.on_surfaces(places).any(axis=1)
        if not np.all(on):
            raise ValueError(f"points {np.flatnonzero(~on)[:10]} are not on the surface: {shape}")
        return places

    def positions(self, places, shape):
        level = places[:, 3]
        z = (np.minimum(level, 1) * shape.plate_thickness
             + np.maximum(level - 1, 0) * shape.boss_height)
        return np.column_stack([footprint.positions(places[:, :3], shape, self.initial), z])

    def on_surfaces(self, places):
        part, first, second, level = places.T
        grid = part == GRID
        on = np.zeros((len(places), len(Surface)), dtype=bool)
        in_plate = (level >= 0) & (level <= 1)
        above = (level >= 1) & (level <= 2)
        plate = ~grid | _within(first, second, (LEFT, RIGHT), (FRONT, BACK))
        rib = grid & _within(first, second, RIB_X, RIB_Y)
        slot = grid & _within(first, second, SLOT_X, SLOT_Y)
        in_rib = grid & _inside(first, second, RIB_X, RIB_Y)
        in_slot = grid & _inside(first, second, SLOT_X, SLOT_Y)

        open_top = plate & ~in_rib & (grid | (first >= 1))
        on[:, S.PLATE_BOTTOM] = plate & (level == 0) & (grid | (first >= 0))
        on[:, S.PLATE_TOP] = open_top & (level == 1)
        on[:, S.RIB_TOP] = rib & ~in_slot & (level == 2)
        on[:, S.SLOT_FLOOR] = slot & (level == 1)
        for region, (x, y), rise, sides in (
            (grid & plate, ((LEFT, RIGHT), (FRONT, BACK)), in_plate, _PRISMS[0][0]),
            (rib, (RIB_X, RIB_Y), above, _PRISMS[1][0]),
            (slot, (SLOT_X, SLOT_Y), above, _PRISMS[2][0]),
        ):
            for side, coordinate, line in zip(sides, (first, second, first, second),
                                              (x[0], y[0], x[1], y[1])):
                on[:, side] = region & rise & (coordinate == line)
        for boss, (bore, wall, top) in zip(BOSSES, (
            (S.LEFT_BORE, S.LEFT_BOSS_WALL, S.LEFT_BOSS_TOP),
            (S.RIGHT_BORE, S.RIGHT_BOSS_WALL, S.RIGHT_BOSS_TOP),
        )):
            here = part == boss
            on[:, bore] = here & (first == 0) & (in_plate | above)
            on[:, wall] = here & (first == 1) & above
            on[:, top] = here & (first >= 0) & (first <= 1) & (level == 2)
        return on

    def angles(self, places):
        return places[:, 2]

    def normals(self, surfaces, points, shape):
        normals = np.zeros((len(points), 3))
        for surface, normal in _PLANES.items():
            normals[surfaces == surface] = normal
        for surface, (side, outward) in _CYLINDERS.items():
            here = surfaces == surface
            axis = (side * shape.boss_spacing / 2, 0)
            radial = points[here, :2] - axis
            normals[here, :2] = outward * radial / np.linalg.norm(radial, axis=1)[:, None]
        return normals

    def volume(self, shape):
        bores = 2 * np.pi * shape.bore_radius**2
        raised = (2 * np.pi * shape.boss_radius**2 - bores + shape.rib_length * shape.rib_thickness
                  - shape.slot_length * shape.slot_width)
        plate = shape.length * shape.width - bores
        return plate * shape.plate_thickness + raised * shape.boss_height

    def hex_mesh(self, small=False):
        """Unstructured quadrilaterals by Gmsh, swept through 5 layers of the plate, under bosses
        and rib through 12 more; small: 2 and 4."""
        from .gmsh_mesh import quadrilaterals

        size, low, high = (0.36, 2, 4) if small else (0.1105, 5, 12)
        points, faces = quadrilaterals(self._build_footprint, size)
        layers = [low + high if self._is_raised(points[quads].mean(axis=1)) else low
                  for quads in faces]
        shape = self.initial
        levels = np.concatenate([
            np.linspace(0, shape.plate_thickness, low + 1),
            shape.plate_thickness + np.linspace(0, shape.boss_height, high + 1)[1:]])
        return self.classified(swept(points, faces, layers, levels))

    def _is_raised(self, centers):
        """Whether the footprint's face with cells at `centers` (m, 2) is under a boss or the
        rib."""
        part, first, second = footprint.locate(centers, self.initial, 0).T
        grid = part == GRID
        boss = ~grid & (first < 1)
        rib = (grid & _inside(first, second, RIB_X, RIB_Y)
               & ~_inside(first, second, SLOT_X, SLOT_Y))
        raised = boss | rib
        if np.any(raised) and not np.all(raised):
            raise RuntimeError("a face of the footprint is neither all raised nor all low")
        return bool(raised[0])

    def tet_mesh(self, small=False):
        from .gmsh_mesh import tetrahedra

        return self.classified(tetrahedra(self._build, 0.31 if small else 0.085))

    def _axes(self):
        return (-self.initial.boss_spacing / 2, self.initial.boss_spacing / 2)

    def _build_footprint(self, occ):
        shape = self.initial

        def disks(radius):
            return [(2, occ.addDisk(x, 0, 0, radius, radius)) for x in self._axes()]

        def rectangle(length, width):
            return (2, occ.addRectangle(-length / 2, -width / 2, 0, length, width))

        plate, _ = occ.cut([rectangle(shape.length, shape.width)], disks(shape.bore_radius))
        bosses, _ = occ.cut(disks(shape.boss_radius), disks(shape.bore_radius))
        rib = rectangle(shape.rib_length, shape.rib_thickness)
        slot = rectangle(shape.slot_length, shape.slot_width)
        occ.fragment(plate, [*bosses, rib, slot])

    def _build(self, occ):
        shape = self.initial
        foot, height = shape.plate_thickness, shape.boss_height

        def box(length, width, z, rise):
            return (3, occ.addBox(-length / 2, -width / 2, z, length, width, rise))

        raised = [(3, occ.addCylinder(x, 0, foot, 0, 0, height, shape.boss_radius))
                  for x in self._axes()]
        raised.append(box(shape.rib_length, shape.rib_thickness, foot, height))
        solid, _ = occ.fuse([box(shape.length, shape.width, 0, foot)], raised)
        holes = [(3, occ.addCylinder(x, 0, 0, 0, 0, foot + height, shape.bore_radius))
                 for x in self._axes()]
        holes.append(box(shape.slot_length, shape.slot_width, foot, height))
        occ.cut(solid, holes)


def _within(first, second, x, y):
    return (first >= x[0]) & (first <= x[1]) & (second >= y[0]) & (second <= y[1])


def _inside(first, second, x, y):
    return (first > x[0]) & (first < x[1]) & (second > y[0]) & (second < y[1])
