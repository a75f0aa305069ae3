# SPDX-License-Identifier: BSD-3-Clause
"""Hexahedra swept upward from the quadrilaterals of a footprint."""

import numpy as np
from vtkmodules.vtkCommonDataModel import VTK_HEXAHEDRON

from .model_mesh import ModelMesh


def swept(points, regions, layers, levels):
    """The ModelMesh of a footprint's quadrilaterals swept through layers of cells.

    points: (n, 2); regions: list of (m, 4) node ids counterclockwise; layers: how many layers from
    the bottom each region has; levels: ascending z of the layers' bounds, one more than the highest
    region has layers. Nodes come level by level, in the footprint's order."""
    used = np.zeros((len(levels), len(points)), dtype=bool)
    for quads, count in zip(regions, layers):
        used[:count + 1, np.unique(quads)] = True
    ids = np.cumsum(used.ravel()).reshape(used.shape) - 1

    cells = []
    for layer in range(len(levels) - 1):
        quads = np.concatenate(
            [quads for quads, count in zip(regions, layers) if layer < count])
        cells.append(np.column_stack([ids[layer][quads], ids[layer + 1][quads]]))

    level, node = np.nonzero(used)
    swept_points = np.column_stack([points[node], np.asarray(levels)[level]])
    return ModelMesh(swept_points, np.concatenate(cells), VTK_HEXAHEDRON)
