# SPDX-License-Identifier: BSD-3-Clause
"""Structured hexahedra around an axis."""

import numpy as np
from vtkmodules.vtkCommonDataModel import VTK_HEXAHEDRON

from .model_mesh import ModelMesh


def around_axis(points):
    """The ModelMesh of a structured grid of points (layers, rings, around, 3) that is closed in its
    third direction. Layers, rings, around must be a left-handed system, such as downward, outward,
    around: then the cells are positive."""
    layers, rings, around, _ = points.shape
    ids = np.arange(layers * rings * around).reshape(layers, rings, around)
    turned = np.roll(ids, -1, axis=2)
    layer = (ids[:, :-1], turned[:, :-1], turned[:, 1:], ids[:, 1:])
    cells = np.stack([c[:-1] for c in layer] + [c[1:] for c in layer], axis=-1)
    return ModelMesh(points.reshape(-1, 3), cells.reshape(-1, 8), VTK_HEXAHEDRON)


def revolved(profile, around):
    """The ModelMesh of a structured section (layers from the top down, rings outward, (r, z))
    revolved about z, with `around` cells."""
    angle = 2 * np.pi * np.arange(around) / around
    radius, z = profile[..., 0, None], profile[..., 1, None]
    x, y = radius * np.cos(angle), radius * np.sin(angle)
    return around_axis(np.stack(np.broadcast_arrays(x, y, z), axis=-1))
