# SPDX-License-Identifier: BSD-3-Clause
"""The flow between a poppet and its seat, in half a revolution of hexahedra. The poppet opens, and
the cells in the gap are stretched to many times their width."""
import numpy as np
from paraview.simple import MorphMesh

from gallery import Example, block, hexahedra, mesh, run

STEM, HEAD, PIPE, HEIGHT, LIFT = 0.3, 0.85, 1.2, 3, 0.3


def step(z, middle, width):
    """From 0 to 1 around z = middle."""
    return 1 / (1 + np.exp(-(z - middle) / width))


def example(n=12):
    points, cells = block(n, 2 * n, 4 * n)
    out, angle, z = points[:, 0], np.pi * points[:, 1], HEIGHT * points[:, 2]
    # A head between two stems; the pipe narrows to the seat above the head.
    inner = STEM + (HEAD - STEM) * step(z, 0.9, 0.08) * (1 - step(z, 1.5, 0.08))
    outer = PIPE - 0.25 * np.exp(-((z - 1.35) / 0.3)**2) - 0.3 * step(z, 1.9, 0.08)
    radius = inner + out * (outer - inner)
    points = np.stack([radius * np.cos(angle), radius * np.sin(angle), z], axis=1)
    poppet, pipe = out == 0, out == 1
    cut = np.isclose(np.sin(angle), 0)

    # The head moves as a whole. On the stems the motion fades to the ends.
    down = np.zeros(points.shape)
    down[:, 2] = -LIFT * np.interp(z, [0.1, 0.7, 1.8, HEIGHT - 0.1], [0, 1, 1, 0])
    before = mesh(points, hexahedra(cells), arrays={"Down": down, "poppet": poppet},
                  surfaces={"pipe": pipe, "cut": cut})
    after = MorphMesh(Input=before, Moving="Array", MovingArray="poppet", Displacement="Array",
                      DisplacementArray="Down", FixedSurfaces=["pipe"],
                      SlidingSurfaces=["cut"], Method="Inversion-free")
    goal = np.where(poppet[:, None], points + down, np.nan)
    return Example("Valve: the poppet opens", before, after, goal, 0, 12)


if __name__ == "__main__":
    run(example())
