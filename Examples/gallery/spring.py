# SPDX-License-Identifier: BSD-3-Clause
"""A spring of square wire, in hexahedra. Only its two ends are prescribed. The wire's
surface is free, and is solved with the interior."""
import numpy as np
from paraview.simple import MorphMesh

from gallery import Example, block, hexahedra, mesh, run

COILS, RADIUS, WIRE, PITCH, STRETCH = 4, 1.0, 0.18, 0.55, 2.0


def example(n=4):
    points, cells = block(n, n, 24 * n)
    u, v = 2 * points[:, 0] - 1, 2 * points[:, 1] - 1
    out, up = WIRE * u, WIRE * v
    along, turn = points[:, 2], 2 * np.pi * COILS * points[:, 2]
    slope = np.arctan2(PITCH, 2 * np.pi * RADIUS)
    tangent = np.stack([-np.sin(turn), np.cos(turn)], axis=1)
    radial = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    flat = (RADIUS + out)[:, None] * radial - (np.sin(slope) * up)[:, None] * tangent
    points = np.c_[flat, PITCH * COILS * along + np.cos(slope) * up]
    # Out, up and along the wire are a left-handed system.
    cells = cells[:, [4, 5, 6, 7, 0, 1, 2, 3]]

    first, last = along == 0, along == 1
    wire = np.maximum(abs(u), abs(v)) == 1
    before = mesh(points, hexahedra(cells), surfaces={"first": first, "last": last, "wire": wire})
    after = MorphMesh(Input=before, Surfaces=["last"], Displacement="Vector",
                      Vector=[0, 0, STRETCH], FixedSurfaces=["first"], FreeSurfaces=["wire"])
    goal = np.where((first | last)[:, None], points + last[:, None] * [0, 0, STRETCH], np.nan)
    return Example("Spring: its upper end is pulled, and the wire follows freely", before, after,
                   goal, 30, 15)


if __name__ == "__main__":
    run(example())
