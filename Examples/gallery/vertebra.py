# SPDX-License-Identifier: BSD-3-Clause
"""A vertebra-like shape of hexahedra: the body, the arch around the canal, and three processes.
Handles at landmarks fit it to another patient's."""
import numpy as np
from paraview.simple import MorphMesh

from gallery import Example, block, hexahedra, joined, mesh, run

CANAL, ARCH = 0.8, 1.2
#: Angle from the front, half angle on the arch, length, half width and half height at the end, and
#: how much lower that is: the body, the spinous process and the transverse processes.
PARTS = ((0, 0.95, 2.2, 1.9, 0.85, 0), (np.pi, 0.25, 2.0, 0.2, 0.3, 0.8),
         (1.9, 0.3, 1.7, 0.25, 0.25, 0.2), (-1.9, 0.3, 1.7, 0.25, 0.25, 0.2))
#: How the farthest node of each part moves: away from the axis, and up; and a node of the canal.
LANDMARKS = ((0.4, 0.3), (1.0, -0.6), (0.7, 0.4), (0.7, 0.4))
HALF = 0.5  # height of the arch


def around(angle, radius, z):
    return np.stack([radius * np.sin(angle), -radius * np.cos(angle), z], axis=-1)


def sector(n, first, last):
    """Of the arch, between two angles."""
    count = max(2, round(n * (last - first)))
    points, cells = block(n // 4, count, n // 2)
    out, along, up = points.T
    return around(first + along * (last - first), CANAL + out * (ARCH - CANAL),
                  HALF * (2 * up - 1)), cells, count


def part(n, count, angle, half, long, wide, high, lower):
    """A process, or the body, which grows out of the arch and is round at its end."""
    points, cells = block(n, count, n // 2)
    out, across, up = points[:, 0], 2 * points[:, 1] - 1, 2 * points[:, 2] - 1
    start = around(half * across, ARCH, HALF * up)
    end = np.stack([wide * across, -ARCH - long + 0.35 * wide * across**2,
                    high * up - lower], axis=-1)
    flat = start + out[:, None] * (end - start)
    turn, radius = np.arctan2(flat[:, 0], -flat[:, 1]), np.hypot(flat[:, 0], flat[:, 1])
    return around(turn + angle, radius, flat[:, 2]), cells


def example(n=12):
    blocks, ends = [], sorted((row[0] % (2 * np.pi), row[1]) for row in PARTS)
    for row in PARTS:
        *arch, count = sector(n, row[0] - row[1], row[0] + row[1])
        blocks += [arch, part(n, count, *row)]
    for (angle, half), (following, other) in zip(ends, ends[1:] + [(2 * np.pi, PARTS[0][1])]):
        blocks.append(sector(n, angle + half, following - other)[:2])
    points, cells = joined(*blocks)

    handles, goal = [], np.full(points.shape, np.nan)
    for (angle, *_), (away, up) in zip(PARTS, LANDMARKS):
        out = around(angle, 1, 0)
        node = np.argmax(points @ out - 1e-3 * abs(points[:, 2]))
        for place, shift in ((node, away * out + [0, 0, up]),
                             (np.argmin(np.linalg.norm(points - CANAL * out, axis=1)), 0 * out)):
            goal[place] = points[place] + shift
            handles += [*points[place], *shift, 0]  # 0: no limit, a thin-plate spline
    before = mesh(points, hexahedra(cells))
    after = MorphMesh(Input=before, Displacement="Handles", Handles=handles, Method="Radial basis")
    return Example("Vertebra: landmarks move to those of another patient", before, after, goal,
                   150, 40)


if __name__ == "__main__":
    run(example())
