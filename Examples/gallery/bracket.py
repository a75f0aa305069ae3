# SPDX-License-Identifier: BSD-3-Clause
"""A bracket of hexahedra. Its bolt hole goes up, and the seat around the hole moves as one body."""
import numpy as np
from paraview.simple import MorphMesh

from gallery import Example, block, hexahedra, joined, mesh, run

RADIUS, SEAT, SIDE, THICKNESS, UP = 0.5, 0.8, 3, 0.4, 0.4


def square_with_hole(n, layers):
    """A square plate in four blocks, with n cells along each of its sides."""
    points, cells = block(n, n, layers)
    u, out = 2 * points[:, 0] - 1, points[:, 1]
    circle = RADIUS * np.stack([np.sin(np.pi / 4 * u), np.cos(np.pi / 4 * u)], axis=1)
    side = SIDE / 2 * np.stack([u, np.ones_like(u)], axis=1)
    # Circles up to the seat's edge, and from there to the square.
    near, far = (4 * out).clip(None, 1)[:, None], (4 * out - 1).clip(0)[:, None] / 3
    flat = (1 - far) * (1 + near * (SEAT / RADIUS - 1)) * circle + far * side
    turned = np.array([[0, 1], [-1, 0]])
    return joined(*[(np.c_[flat @ np.linalg.matrix_power(turned, quarter), points[:, 2]], cells)
                    for quarter in range(4)])


def example(n=12):
    flat, cells = square_with_hole(n, 2)
    # The plate's first two directions are y and z: the order x, y, z is a turn of them.
    upright = np.stack([THICKNESS * flat[:, 2], flat[:, 0], flat[:, 1] + SIDE / 2 + THICKNESS],
                       axis=1)
    corner, corner_cells = block(2, n, 2)
    corner = corner * [THICKNESS, SIDE, THICKNESS] - [0, SIDE / 2, 0]
    foot, foot_cells = block(n, n, 2)
    foot = foot * [SIDE, SIDE, THICKNESS] + [THICKNESS, -SIDE / 2, 0]
    points, cells = joined((upright, cells), (corner, corner_cells), (foot, foot_cells))

    from_axis = np.hypot(points[:, 1], points[:, 2] - SIDE / 2 - THICKNESS)
    hole, seat = from_axis < RADIUS + 1e-6, from_axis < SEAT + 1e-6
    before = mesh(points, hexahedra(cells), surfaces={"hole": hole}, arrays={"seat": seat})
    after = MorphMesh(Input=before, Surfaces=["hole"], Displacement="Vector", Vector=[0, 0, UP],
                      RigidZones=["seat"])
    goal = np.where(seat[:, None], points + [0, 0, UP], np.nan)
    return Example("Bracket: the hole and its seat go up", before, after, goal, 35, 25)


if __name__ == "__main__":
    run(example())
