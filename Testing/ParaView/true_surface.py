# SPDX-License-Identifier: BSD-3-Clause
"""A model's true surface as fine triangles: a target to project onto. Between the mesh's nodes its
points are found from the surface's equations (model_equations), not from the model's own maps."""

import numpy as np

from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.util.numpy_support import numpy_to_vtkIdTypeArray

from model_checks import Models  # noqa: F401  (Data on the path)
from Models.model_mesh import vtk_points


def _lattice(corners, pieces):
    """Weights (n, corners) of the points that cut a face into pieces x pieces, on which edge each
    is (its number, -1 inside and at the corners), and the triangles between them."""
    step = np.arange(pieces + 1)
    j, i = np.meshgrid(step, step)
    if corners == 3:
        keep = i + j <= pieces
        a, b = i[keep] / pieces, j[keep] / pieces
        weights = np.column_stack([1 - a - b, a, b])
    else:
        keep = np.ones_like(i, bool)
        a, b = i.ravel() / pieces, j.ravel() / pieces
        weights = np.column_stack([(1 - a) * (1 - b), a * (1 - b), a * b, (1 - a) * b])
    number = np.full(keep.shape, -1)
    number[keep] = np.arange(np.count_nonzero(keep))
    triangles = []
    for p in range(pieces):
        for q in range(pieces):
            for triple in (((p, q), (p + 1, q), (p, q + 1)),
                           ((p + 1, q), (p + 1, q + 1), (p, q + 1))):
                if all(keep[place] for place in triple):
                    triangles.append([number[place] for place in triple])
    touched = weights > 0
    edge = np.full(len(weights), -1)
    for k in range(corners):
        both = touched[:, k] & touched[:, (k + 1) % corners] & (touched.sum(axis=1) == 2)
        edge[both] = k
    return weights, edge, np.array(triangles)


def _onto_surfaces(equations, shape, points, first, second):
    """Newton's method, by least norm, onto the surfaces `first` and `second` of each point; these
    may be one."""
    which = np.arange(len(points))
    for _ in range(8):
        distance = np.empty((len(points), 2))
        gradient = np.empty((len(points), 2, 3))
        at = equations(shape, points)
        ahead, behind = ([equations(shape, points + step * axis) for axis in np.eye(3)]
                         for step in (1e-6, -1e-6))
        for k, surface in enumerate((first, second)):
            distance[:, k] = at[surface, which]
            for axis in range(3):
                difference = ahead[axis][surface, which] - behind[axis][surface, which]
                gradient[:, k, axis] = difference / 2e-6
        # Where the two surfaces are one, or touch, only their common normal counts.
        matrix = gradient @ np.moveaxis(gradient, 1, 2) + 1e-12 * np.eye(2)
        points = points - np.einsum(
            "nki,nk->ni", gradient, np.linalg.solve(matrix, distance[:, :, None])[:, :, 0])
    return points


def true_surface(mesh, equations, t, pieces):
    """vtkPolyData: each boundary face of a ClassifiedMesh at S_t cut into pieces x pieces, in
    triangles that share no points, and its new points taken onto its surface, on edges between
    surfaces onto both. Raises ValueError where that does not succeed to 1e-9 of the model's
    size."""
    shape = mesh.model.parameters(t)
    faces, surface = mesh.faces, mesh.face_surface
    count, corners = faces.shape
    weights, edge, triangles = _lattice(corners, pieces)

    ends = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=-1), axis=2).reshape(-1, 2)
    order = np.lexsort((ends[:, 1], ends[:, 0]))
    beyond = np.empty(len(ends), int)  # the surface across each edge: a closed surface pairs them
    beyond[order[0::2]] = np.repeat(surface, corners)[order[1::2]]
    beyond[order[1::2]] = np.repeat(surface, corners)[order[0::2]]
    beyond = beyond.reshape(count, corners)

    moved = mesh.moved(t)
    points = np.einsum("lk,fki->fli", weights, moved[faces]).reshape(-1, 3)
    first = np.repeat(surface, len(weights))
    second = np.where(edge >= 0, beyond[:, edge], surface[:, None]).ravel()
    is_corner = np.tile(weights.max(axis=1) == 1, count)
    new = ~is_corner
    points[new] = _onto_surfaces(equations, shape, points[new], first[new], second[new])
    distance = equations(shape, points)
    which = np.arange(len(points))
    off = np.maximum(np.abs(distance[first, which]), np.abs(distance[second, which])).max()
    if not off < 1e-9 * np.ptp(mesh.points, axis=0).max():
        raise ValueError(f"points of the true surface are off it by {off}")

    cells = (triangles[None] + len(weights) * np.arange(count)[:, None, None]).reshape(-1, 3)
    array = vtkCellArray()
    array.SetData(numpy_to_vtkIdTypeArray(3 * np.arange(len(cells) + 1, dtype=np.int64), deep=1),
                  numpy_to_vtkIdTypeArray(np.ascontiguousarray(cells, np.int64).ravel(), deep=1))
    data = vtkPolyData()
    data.SetPoints(vtk_points(points))
    data.SetPolys(array)
    return data
