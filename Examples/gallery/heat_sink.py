# SPDX-License-Identifier: BSD-3-Clause
"""A heat sink of hexahedra. A lattice of eight control points around its fins splays them."""
import numpy as np
from paraview.simple import MorphMesh

from gallery import Example, block, hexahedra, joined, mesh, run

FINS, PITCH, FIN, DEEP, BASE, HIGH, SPREAD = 6, 0.5, 0.2, 2.0, 0.3, 1.4, 0.9


def example(n=8):
    parts = []

    def add(x, wide, z, high, across, up):
        points, cells = block(across, n, up)
        parts.append((points * [wide, DEEP, high] + [x, 0, z], cells))

    for number in range(FINS):
        x = number * PITCH
        add(x, FIN, 0, BASE, 3, 2)
        add(x, FIN, BASE, HIGH, 3, n)
        if number < FINS - 1:
            add(x + FIN, PITCH - FIN, 0, BASE, 3, 2)
    points, cells = joined(*parts)
    width = points[:, 0].max()

    before = mesh(points, hexahedra(cells))
    after = MorphMesh(Input=before, Displacement="Lattice", LatticeSize=[2, 2, 2], LatticeBox="Own",
                      LatticePosition=[0, 0, BASE], LatticeLength=[width, DEEP, HIGH],
                      Method="Simplex-natural neighbor")
    # The four upper control points: i, j, k and their displacements.
    after.LatticeDisplacements = [number for i in (0, 1) for j in (0, 1)
                                  for number in (i, j, 1, (2 * i - 1) * SPREAD, 0, 0)]
    up = ((points[:, 2] - BASE) / HIGH).clip(0)
    goal = points.copy()
    goal[:, 0] += up * SPREAD * (2 * points[:, 0] / width - 1)
    inside = (points[:, 1] > 1e-6) & (points[:, 1] < DEEP - 1e-6)
    goal[inside] = np.nan
    return Example("Heat sink: a lattice around the fins splays them", before, after, goal, 25, 25)


if __name__ == "__main__":
    run(example())
