# SPDX-License-Identifier: BSD-3-Clause
"""A block of rock in wedges. Its flat top goes to the terrain of a survey, straight along z."""
import numpy as np
from paraview.simple import ExtractSurface, MorphMesh

from gallery import Example, block, mesh, run, triangles, wedges

LENGTH, WIDTH, DEPTH = 6, 4, 1.6


def terrain(x, y):
    """Height of the ground: a meander cut into a plateau with two hills."""
    river = 2 + 0.7 * np.sin(1.3 * x)
    return (0.25 * np.exp(-(x - 1)**2 - (y - 3.4)**2) + 0.35 * np.exp(-(x - 4.6)**2 - (y - 0.4)**2)
            - 0.9 * np.exp(-((y - river) / 0.8)**4))


def example(n=24):
    points, cells = block(3 * n // 2, n, n // 3)
    points = points * [LENGTH, WIDTH, DEPTH] - [0, 0, DEPTH]
    before = mesh(points, wedges(cells), surfaces={"top": points[:, 2] == 0})

    # The survey stands for a file: a surface of triangles, finer than the mesh and larger.
    survey, faces = block(6 * n, 4 * n)
    survey = (1.1 * survey - 0.05) * [LENGTH, WIDTH]
    survey = np.c_[survey, terrain(*survey.T)]
    after = MorphMesh(Input=before, Surfaces=["top"], Displacement="Target",
                      Target=ExtractSurface(Input=mesh(survey, triangles(faces))),
                      ProjectAlong="z", TargetAngle=180, Method="LBWARP")
    return Example("Canyon: the flat top goes to the surveyed terrain, along z", before, after,
                   azimuth=50, tilt=40)


if __name__ == "__main__":
    run(example())
