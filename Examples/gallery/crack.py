# SPDX-License-Identifier: BSD-3-Clause
"""A plate of hexahedra in an octree, finer around the tip of a crack, so that nodes hang between
coarse and fine cells. The crack opens."""
import numpy as np
from paraview.simple import MorphMesh

from gallery import Example, block, hexahedra, joined, mesh, run

SIDE, LENGTH, OPENING = 8, 4, 0.5


def octree(half, levels):
    """The half y > 0 of the plate in cubes of side 1 / 2^level, the finer the nearer to the tip."""
    points, cells = block(SIDE, SIDE // 2, 1)
    cubes = [(origin, 1.0) for origin in points[cells[:, 0]] * [SIDE, SIDE // 2, 1]]
    for level in range(1, levels + 1):
        reach, kept = 6 / 2**level, []
        for origin, size in cubes:
            near = np.linalg.norm(origin[:2] + size / 2 - [LENGTH, 0]) < reach
            if size > 2.0**(1 - level) or not near:
                kept.append((origin, size))
                continue
            kept += [(origin + size / 2 * np.array(corner), size / 2)
                     for corner in np.ndindex(2, 2, 2)]
        cubes = kept
    unit, cell = block(1, 1, 1)
    points, cells = joined(*[(origin + size * unit, cell) for origin, size in cubes])
    return points * [1, half, 1], cells if half > 0 else cells[:, [3, 2, 1, 0, 7, 6, 5, 4]]


def example(n=4):
    levels = n // 2
    upper, upper_cells = octree(1, levels)
    lower, lower_cells = octree(-1, levels)
    points, cells = joined((upper, upper_cells), (lower, lower_cells))
    # The lower cells get nodes of their own on the crack, which is y = 0 up to its tip.
    crack = np.flatnonzero((points[:, 1] == 0) & (points[:, 0] < LENGTH))
    own = np.arange(len(points))
    own[crack] = len(points) + np.arange(len(crack))
    below = points[cells].mean(axis=1)[:, 1] < 0
    cells[below] = own[cells[below]]
    points = np.concatenate([points, points[crack]])

    side = np.zeros(len(points))
    side[crack], side[own[crack]] = 1, -1
    opening = np.zeros(points.shape)
    opening[:, 1] = side * OPENING * np.sqrt((1 - points[:, 0] / LENGTH).clip(0))
    before = mesh(points, hexahedra(cells), arrays={"crack": side, "Opening": opening})
    after = MorphMesh(Input=before, Moving="Array", MovingArray="crack", Displacement="Array",
                      DisplacementArray="Opening")
    goal = np.where(side[:, None] != 0, points + opening, np.nan)
    return Example("Cracked plate: the crack opens, in an octree with hanging nodes", before,
                   after, goal, 15, 55)


if __name__ == "__main__":
    run(example())
