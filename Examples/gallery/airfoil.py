# SPDX-License-Identifier: BSD-3-Clause
"""A plane mesh about a wing's section, with layers of quadrilaterals at the wall and triangles
around them. The rear bends down as a flap, and the layers keep their heights."""
import numpy as np
from paraview.simple import MorphMesh

from gallery import Example, block, mesh, quadrilaterals, run, triangles

CENTER, RADIUS, FIRST, GROWTH, FAR = -0.1, 1.13, 8e-3, 1.25, 8
HINGE, DOWN = 0.2, 0.7


def section(n):
    """Rings around a Joukowski section, whose trailing edge is slightly round: (rings, n, 2). The
    map z = w + 1 / w is conformal, so that cells are as square as between circles."""
    radii, step = [RADIUS], FIRST
    while radii[-1] < FAR:
        radii.append(radii[-1] + step)
        step = min(GROWTH * step, 2 * np.pi / n * radii[-1])
    w = CENTER + np.outer(radii, np.exp(2j * np.pi * np.arange(n) / n))
    z = w + 1 / w
    return np.stack([z.real, z.imag], axis=-1)


def example(n=96):
    layers = n // 12
    points = section(n)
    rings = len(points) - 1
    _, cells = block(rings, n)
    ring, k = np.divmod(cells, n + 1)
    cells, ring = ring * n + k % n, ring.max(axis=1)  # the last column is the first
    points, at_wall, near = points.reshape(-1, 2), np.arange(n * (rings + 1)) < n, ring <= layers

    bend = np.zeros((len(points), 3))
    rear = (points[:, 0] - HINGE).clip(0) / (points[at_wall, 0].max() - HINGE)
    bend[:, 1] = np.where(at_wall, -DOWN * rear**2, 0)
    before = mesh(points, quadrilaterals(cells[near]), triangles(cells[~near]),
                  surfaces={"airfoil": at_wall}, arrays={"Bend": bend})
    after = MorphMesh(Input=before, Moving="Surfaces", Surfaces=["airfoil"], Displacement="Array",
                      DisplacementArray="Bend", KeepLayers=layers, Stiffness="Inverse volume")
    goal = np.where(at_wall[:, None], np.pad(points, ((0, 0), (0, 1))) + bend, np.nan)
    shown = ring <= layers + n // 10
    shown = np.r_[shown[near], np.repeat(shown[~near], 2)]
    return Example("Airfoil: the rear bends down, eight layers of cells stay on the wall",
                   before, after, goal, 0, 90, lambda _: shown)


if __name__ == "__main__":
    run(example())
