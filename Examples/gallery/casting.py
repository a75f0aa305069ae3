# SPDX-License-Identifier: BSD-3-Clause
"""A casting of tetrahedra, a plate with a rib and bosses. It shrinks and warps as it cools, by the
displacements that an analysis has on a coarser mesh."""
import numpy as np
from paraview.simple import MorphMesh

from gallery import Example, block, hexahedra, joined, mesh, run, tetrahedra

#: Boxes that are joined: the smallest and the largest x, y and z.
BOXES = ((0, 6, 0, 3, 0, 0.5), (0.5, 1.5, 1, 2, 0.5, 2), (4, 5.5, 0.5, 2, 0.5, 1.5),
         (1.5, 4, 1, 1.5, 0.5, 1), (2.5, 3, 1.5, 3, 0.5, 1))
SHRINKAGE, WARP = 0.05, 0.8


def casting(n):
    """Of n cubes a unit of length; n is even."""
    points, cells = block(6 * n, 3 * n, 2 * n)
    points = points * [6, 3, 2]
    x, y, z = points[cells].mean(axis=1).T
    inside = [(x0 < x) & (x < x1) & (y0 < y) & (y < y1) & (z0 < z) & (z < z1)
              for x0, x1, y0, y1, z0, z1 in BOXES]
    return joined((points, cells[np.any(inside, axis=0)]))


def cooling(points):
    along, across = points[:, :1] / 3 - 1, points[:, 1:2] / 1.5 - 1
    return -SHRINKAGE * points + WARP * (along**2 + 0.5 * along * across) * [0, 0, 1]


def example(n=4):
    # The analysis stands for a file, of which only the displacements at its own nodes are known.
    coarse, coarse_cells = casting(2)
    analysis = mesh(coarse, hexahedra(coarse_cells), arrays={"Cooling": cooling(coarse)})
    points, cells = casting(n)
    before = mesh(points, tetrahedra(cells))
    after = MorphMesh(Input=before, Moving="Everything", Displacement="Field", Field=analysis,
                      FieldArray="Cooling")
    at_coarse_node = (points[:, 2] == 0) & ((2 * points) % 1 == 0).all(axis=1)
    goal = np.where(at_coarse_node[:, None], points + cooling(points), np.nan)
    return Example("Casting: it shrinks and warps as a coarse analysis says", before, after, goal,
                   20, 25)


if __name__ == "__main__":
    run(example())
