# SPDX-License-Identifier: BSD-3-Clause
"""The meshes of the study, the same on every machine to the last bit."""

import numpy as np

import Models


def settled(points):
    """Points to ten decimals: without the last bits of NumPy's sines and products, which differ
    from one processor to the next. Simplex-linear's ties, points on one sphere, would change with
    these bits."""
    return np.round(points, 10)


def study_mesh(name, kind, small):
    """The ClassifiedMesh of a model, "hex" or "tet": small, from its file, or of the paper's
    size."""
    model = Models.get(name)
    mesh = model.read_small(kind) if small else model.make(kind)
    mesh.points[:] = settled(mesh.points)
    return mesh
