# SPDX-License-Identifier: BSD-3-Clause
"""The courier's footprint: a map of the plane that carries the lines of one shape to another's.

A rectilinear grid of lines through the plate's edges, squares around the bosses, the rib and its
slot is laid over the footprint. Its crossings move with the shape; between them the map is
bilinear. Inside a boss's square it is linear in the radius along each ray from the boss's axis:
from the bore to the boss's outer wall, and on to the square.

    0  1   2  3 4   5 6  7   8  9
    |--|---|--|-----|-|--|---|--| 7  the plate's edge
    |--|---|--|-----|-|--|---|--| 6  squares
    |  | O |  |[===]|    | O |  |    5, 4, 3, 2: rib, slot, slot, rib
    |--|---|--|-----|-|--|---|--| 1
    |--|---|--|-----|-|--|---|--| 0

The map is continuous, keeps fractions of the arc length on every curve of the model, and does not
fold: each rectangle goes to a convex quadrilateral, each ray to a ray.
"""

import numpy as np

from .columns import columns

# Numbers of the grid's lines (see above).
LEFT, RIGHT = 0, 9
RIB_X, SLOT_X = (3, 6), (4, 5)
FRONT, BACK = 0, 7
RIB_Y, SLOT_Y = (2, 5), (3, 4)
_SQUARE_X, _SQUARE_Y = ((1, 2), (7, 8)), (1, 6)

GRID, BOSSES = 0, (1, 2)  #: parts: the bilinear grid, left boss, right boss


def lines(shape):
    """x (10,) and y (8,) of the grid's lines where they are straight, which is at S_0."""
    boss, square = shape.boss_spacing / 2, shape.square / 2
    x = np.array([shape.slot_length / 2, shape.rib_length / 2, boss - square, boss + square,
                  shape.length / 2])
    y = np.array([shape.slot_width / 2, shape.rib_thickness / 2, square, shape.width / 2])
    return np.concatenate([-x[::-1], x]), np.concatenate([-y[::-1], y])


def crossings(shape, initial):
    """(10, 8, 2): where the crossings of the initial shape's lines are on another shape."""
    x, y = lines(shape)
    x0, y0 = lines(initial)
    moved = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1)
    # A straight edge keeps its fractions, so the lines bend to meet it.
    moved[:, [FRONT, BACK], 0] = (x0 * (shape.length / initial.length))[:, None]
    moved[[LEFT, RIGHT], :, 1] = y0 * (shape.width / initial.width)
    square = y0 * (shape.square / initial.square)
    for column in np.ravel(_SQUARE_X):
        moved[column, _SQUARE_Y[0]:_SQUARE_Y[1] + 1, 1] = square[_SQUARE_Y[0]:_SQUARE_Y[1] + 1]
    return moved


def locate(points, shape, tolerance):
    """(n, 3): part, and two coordinates, of points (n, 2) on the initial shape. In the GRID: the
    numbers of lines and fractions between. In a boss: 0 at the bore to 1 at the outer wall to 2 at
    the square, and radians about the axis. Whole numbers within `tolerance` of their line, in the
    model's unit."""
    places = np.zeros((len(points), 3))
    for column, line in enumerate(lines(shape)):
        value = points[:, column]
        near = np.argmin(np.abs(value[:, None] - line), axis=1)
        value = np.where(np.abs(value - line[near]) <= tolerance, line[near], value)
        # Beyond the grid extrapolated, to be recognized as outside.
        cell = np.clip(np.searchsorted(line, value, side="right") - 1, 0, len(line) - 2)
        places[:, 1 + column] = cell + (value - line[cell]) / (line[cell + 1] - line[cell])

    for part, sign in zip(BOSSES, (-1, 1)):
        local = points - (sign * shape.boss_spacing / 2, 0)
        inside = np.abs(local).max(axis=1) <= shape.square / 2 + tolerance
        x, y = columns(local[inside])
        radius, angle = np.hypot(x, y), np.arctan2(y, x)
        angle[radius * np.abs(angle) <= tolerance] = 0
        knots = _knots(angle, shape)
        for knot in knots:
            radius = np.where(np.abs(radius - knot) <= tolerance, knot, radius)
        wall = (radius - knots[0]) / (knots[1] - knots[0])
        beyond = 1 + (radius - knots[1]) / (knots[2] - knots[1])
        places[inside] = np.column_stack(
            [np.full(len(x), part), np.where(radius <= knots[1], wall, beyond), angle])
    return places


def positions(places, shape, initial):
    """(n, 2): positions on `shape` of places found on the initial one."""
    part, first, second = columns(places)
    corners = crossings(shape, initial)
    i = np.clip(first.astype(int), 0, len(corners) - 2)
    j = np.clip(second.astype(int), 0, corners.shape[1] - 2)
    u, v = (first - i)[:, None], (second - j)[:, None]
    moved = ((1 - v) * ((1 - u) * corners[i, j] + u * corners[i + 1, j])
             + v * ((1 - u) * corners[i, j + 1] + u * corners[i + 1, j + 1]))
    for boss, sign in zip(BOSSES, (-1, 1)):
        nodes = part == boss
        level, angle = first[nodes], second[nodes]
        knots = _knots(angle, shape)
        wall = (1 - level) * knots[0] + level * knots[1]
        beyond = (2 - level) * knots[1] + (level - 1) * knots[2]
        radius = np.where(level <= 1, wall, beyond)
        moved[nodes] = np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])
        moved[nodes, 0] += sign * shape.boss_spacing / 2
    return moved


def _knots(angle, shape):
    """Radii (3, n) of bore, boss and square along rays."""
    square = shape.square / 2 / np.maximum(np.abs(np.cos(angle)), np.abs(np.sin(angle)))
    return np.stack([np.full_like(square, shape.bore_radius),
                     np.full_like(square, shape.boss_radius), square])
