# SPDX-License-Identifier: BSD-3-Clause
"""FEMWARP on tetrahedra in numpy alone, to compare with: Laplace's equation by linear finite
elements, solved by conjugate gradients."""

import numpy as np


def laplace_on_tetrahedra(points, cells, fixed, values, tolerance=1e-10):
    """(n, k): the field that is harmonic on a mesh of tetrahedra.

    points (n, 3), cells (m, 4), fixed: ids (b,) of nodes, values (b, k): the field there.
    tolerance: the residual's norm over the first one's."""
    corners = points[cells]
    edges = corners[:, 1:] - corners[:, :1]
    volume = np.linalg.det(edges) / 6
    inverse = np.linalg.inv(edges)  # column i: the gradient of corner i + 1
    gradients = np.concatenate([-inverse.sum(axis=2, keepdims=True), inverse], axis=2)
    stiffness = volume[:, None, None] * np.einsum("cki,ckj->cij", gradients, gradients)
    free = np.ones(len(points), dtype=bool)
    free[fixed] = False
    rows = cells.ravel()

    def times(field):
        cell_values = np.einsum("cij,cjk->cik", stiffness, field[cells]).reshape(len(rows), -1)
        product = np.column_stack([
            np.bincount(rows, column, len(points)) for column in cell_values.T])
        product[~free] = 0
        return product

    diagonal = np.bincount(rows, np.einsum("cii->ci", stiffness).ravel(), len(points))[:, None]
    field = np.zeros((len(points), values.shape[1]))
    field[fixed] = values
    residual = -times(field)
    first = np.linalg.norm(residual, axis=0)
    scaled = residual / diagonal
    direction, energy = scaled, np.sum(residual * scaled, axis=0)
    while np.any(np.linalg.norm(residual, axis=0) > tolerance * first):
        image = times(direction)
        length = energy / np.maximum(np.sum(direction * image, axis=0), 1e-300)
        field += length * direction
        residual = residual - length * image
        scaled = residual / diagonal
        before, energy = energy, np.sum(residual * scaled, axis=0)
        direction = scaled + energy / np.maximum(before, 1e-300) * direction
    return field
