# SPDX-License-Identifier: BSD-3-Clause
"""A casting of tetrahedra, a plate with ribs and bosses, fitted to a scan. It has shrunk and warped,
and the scan has axes of its own, so it is aligned first."""
import numpy as np
from paraview.simple import Calculator, ExtractSurface, FittoSurface, Transform

from gallery import Example, block, joined, mesh, run, tetrahedra

#: Boxes that are joined: the smallest and the largest x, y and z.
BOXES = ((0, 6, 0, 3, 0, 0.5), (0.5, 1.5, 1, 2, 0.5, 2), (4, 5.5, 0.5, 2, 0.5, 1.5),
         (1.5, 4, 1, 1.5, 0.5, 1), (2.5, 3, 1.5, 3, 0.5, 1))


def example(n=4):
    """n: cells a unit of length, an even number."""
    points, cells = block(6 * n, 3 * n, 2 * n)
    points = points * [6, 3, 2]
    x, y, z = points[cells].mean(axis=1).T
    inside = [(x0 < x) & (x < x1) & (y0 < y) & (y < y1) & (z0 < z) & (z < z1)
              for x0, x1, y0, y1, z0, z1 in BOXES]
    points, cells = joined((points, cells[np.any(inside, axis=0)]))
    before = mesh(points, tetrahedra(cells))

    # The scan stands for a file: shrunk by 3 %, its ends higher than its middle, turned, shifted.
    warped = Calculator(Input=ExtractSurface(Input=before), CoordinateResults=1,
                        Function="0.97*coords + 0.7*((coordsX - 3)/3)^2*kHat")
    scan = Transform(Input=warped)
    scan.Transform.Rotate, scan.Transform.Translate = [0, 4, 12], [0.3, 0.2, 0.4]
    after = FittoSurface(Input=before, Target=scan, AlignTarget=1)
    return Example("Casting: fitted to a scan that has shrunk and warped", before, after,
                   azimuth=20, tilt=30)


if __name__ == "__main__":
    run(example())
