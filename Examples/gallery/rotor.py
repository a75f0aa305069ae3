# SPDX-License-Identifier: BSD-3-Clause
"""A rotor of hexahedra with five blades. Two saved shapes, a twist and a sweep of the blades, are
blended by their weights."""
import numpy as np
from paraview.simple import BoundaryDisplacement, MorphShapes

from gallery import Example, block, hexahedra, joined, mesh, run

BLADES, BORE, HUB, TIP, HEIGHT, WIDTH = 5, 0.5, 1.0, 3.0, 0.8, 0.22
TWIST, SWEEP, WEIGHTS = np.radians(35), 0.7, [1, 0.8]


def blade(n):
    """Above the hub from -WIDTH to WIDTH radians, wider than there at its tip."""
    points, cells = block(3 * n, 2, n)
    radius = HUB + (TIP - HUB) * points[:, 0]
    across = (2 * points[:, 1] - 1) * WIDTH * (HUB + 0.15 * (radius - HUB))
    return radius, across / radius, HEIGHT * points[:, 2], cells


def displacements(points):
    """Of a twist about each blade's own axis, and of a sweep around z, by arc length."""
    x, y, z = points.T
    turn, radius = np.arctan2(y, x), np.hypot(x, y)
    out = ((radius - HUB) / (TIP - HUB)).clip(0)
    axis = 2 * np.pi / BLADES * np.round(turn / (2 * np.pi / BLADES))
    across, up = radius * np.sin(turn - axis), z - HEIGHT / 2
    angle = TWIST * out**1.5
    side = np.cos(angle) * across - np.sin(angle) * up - across
    lift = np.sin(angle) * across + np.cos(angle) * up - up
    twist = np.stack([-side * np.sin(axis), side * np.cos(axis), lift], axis=1)
    arc = SWEEP * out**2
    sweep = np.stack([-arc * np.sin(axis), arc * np.cos(axis), 0 * arc], axis=1)
    return twist, sweep


def example(n=6):
    around = 2 * np.pi / BLADES
    radius, turn, z, cells = blade(n)
    parts = []
    gap, gap_cells = block(n // 2, n, n)
    foot, foot_cells = block(n // 2, 2, n)
    for number in range(BLADES):
        for share, first, last, some in ((foot, -WIDTH, WIDTH, foot_cells),
                                         (gap, WIDTH, around - WIDTH, gap_cells)):
            r, t = BORE + (HUB - BORE) * share[:, 0], first + (last - first) * share[:, 1]
            t = t + number * around
            parts.append((np.stack([r * np.cos(t), r * np.sin(t), HEIGHT * share[:, 2]], 1), some))
        t = turn + number * around
        parts.append((np.stack([radius * np.cos(t), radius * np.sin(t), z], axis=1), cells))
    points, cells = joined(*parts)

    twist, sweep = displacements(points)
    before = mesh(points, hexahedra(cells), arrays={"twist": twist, "sweep": sweep})
    shapes = [BoundaryDisplacement(Input=before, Moving="Everything", Displacement="Array",
                                   DisplacementArray=name) for name in ("twist", "sweep")]
    after = MorphShapes(Input=before, Shapes=shapes, ShapeNames=["twist", "sweep"],
                        Weights=WEIGHTS, FindValidRanges=0)
    outside = np.isclose(points[:, 2], 0) | np.isclose(points[:, 2], HEIGHT)
    goal = points + WEIGHTS[0] * twist + WEIGHTS[1] * sweep
    return Example("Rotor: a twist and a sweep of the blades, blended", before, after,
                   np.where(outside[:, None], goal, np.nan), 20, 45)


if __name__ == "__main__":
    run(example())
