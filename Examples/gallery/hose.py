# SPDX-License-Identifier: BSD-3-Clause
"""A straight hose becomes an elbow, by one displacement for each node of its boundary."""
import numpy as np
from paraview.simple import MorphMesh

from gallery import Example, block, hexahedra, joined, mesh, run

INNER, OUTER, LENGTH, BEND = 0.5, 0.8, 6, 2.1


def bent(points):
    """The hose is along x. Its middle two thirds bend by BEND, in radians, about an axis along y,
    and its ends stay straight."""
    first, long = LENGTH / 6, 2 * LENGTH / 3
    radius = long / BEND
    angle = BEND * ((points[:, 0] - first) / long).clip(0, 1)
    begin, end = np.minimum(points[:, 0], first), (points[:, 0] - first - long).clip(0)
    out = radius + points[:, 2]
    return np.stack([begin + out * np.sin(angle) + end * np.cos(angle), points[:, 1],
                     out * np.cos(angle) - radius - end * np.sin(angle)], axis=1)


def example(n=4):
    points, cells = block(n, 8 * n, 12 * n)
    radius, angle = INNER + points[:, 0] * (OUTER - INNER), 2 * np.pi * points[:, 1]
    points = np.stack([LENGTH * points[:, 2], radius * np.cos(angle), radius * np.sin(angle)],
                      axis=1)
    points, cells = joined((points, cells))
    goal = bent(points)
    before = mesh(points, hexahedra(cells), arrays={"Bend": goal - points})
    after = MorphMesh(Input=before, Moving="Everything", Displacement="Array",
                      DisplacementArray="Bend", Method="Simplex-linear")
    radius = np.hypot(points[:, 1], points[:, 2])
    inside = (radius > INNER + 1e-6) & (radius < OUTER - 1e-6) & (points[:, 0] % LENGTH > 1e-6)
    goal[inside] = np.nan
    return Example("Hose: a straight hose is bent to an elbow", before, after, goal, 20, 20)


if __name__ == "__main__":
    run(example())
