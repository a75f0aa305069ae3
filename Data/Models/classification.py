# SPDX-License-Identifier: BSD-3-Clause
"""Which geometry owns a node or a boundary face, found from the surfaces it lies on."""

from dataclasses import dataclass

import numpy as np


@dataclass
class Ownership:
    """One entry for each of n boundary nodes.

    dimension: 0 vertex, 1 curve, 2 surface; int8.
    number: id of the vertex, curve or surface; int32.
    curve_parameter: in [0, 1], fraction of the arc length; 0 for nodes not on a curve; float64.
    """

    dimension: np.ndarray
    number: np.ndarray
    curve_parameter: np.ndarray


def owners(model, places, points):
    """The Ownership of boundary nodes with these places, (n, k), at these points, (n, 3), of S_0.
    Raises ValueError for a node on surfaces that share no curve or vertex of the model."""
    on = model.on_surfaces(places)
    count = on.sum(axis=1)
    code = on @ _bits(on.shape[1])
    found = Ownership(
        np.full(len(on), 2, np.int8), np.argmax(on, axis=1).astype(np.int32), np.zeros(len(on)))
    owned = count == 1

    angles = model.angles(places)
    for number, curve in enumerate(model.curves):
        nodes = code == _code(curve.surfaces)
        found.dimension[nodes], found.number[nodes] = 1, number
        if curve.closed:
            found.curve_parameter[nodes] = np.mod(angles[nodes] / (2 * np.pi), 1)
        owned |= nodes
    for number, (surfaces, curve) in enumerate(model.vertices):
        nodes = code == _code(surfaces)
        if curve is not None:
            nodes &= angles == 0
        found.dimension[nodes], found.number[nodes] = 0, number
        found.curve_parameter[nodes] = 0
        owned |= nodes
    if not np.all(owned):
        lost = np.flatnonzero(~owned)
        raise ValueError(f"boundary nodes {lost[:10]} of {model.name} are on surfaces that share"
                         f" no curve: {[np.flatnonzero(row).tolist() for row in on[lost[:10]]]}")
    _open_curve_parameters(model, found, points)
    return found


def _open_curve_parameters(model, found, points):
    for number, curve in enumerate(model.curves):
        if curve.closed:
            continue
        ends = [np.flatnonzero((found.dimension == 0) & (found.number == vertex))
                for vertex in model.curve_ends(number)]
        if any(len(end) != 1 for end in ends):
            raise ValueError(f"the mesh has no node on an end of curve {number} of {model.name}")
        first, last = (points[end[0]] for end in ends)
        nodes = (found.dimension == 1) & (found.number == number)
        along = (points[nodes] - first) @ (last - first)
        found.curve_parameter[nodes] = along / np.dot(last - first, last - first)


def face_surfaces(model, places, points, faces):
    """(#faces,) int32: the surface of each boundary face. `faces`: (#faces, 3 or 4) numbers of
    boundary nodes, seen from outside counterclockwise. A face all of whose nodes are on two
    surfaces, as a triangle between three nodes of one circle, is on that whose normal is nearer.
    Raises ValueError for a face whose nodes share no surface."""
    on = model.on_surfaces(places)
    shared = np.logical_and.reduce([on[faces[:, corner]] for corner in range(faces.shape[1])])
    if not np.all(shared.any(axis=1)):
        lost = np.flatnonzero(~shared.any(axis=1))
        raise ValueError(f"the nodes of boundary faces {lost[:10]} of {model.name} share no"
                         f" surface: {faces[lost[:3]].tolist()}")
    surface = np.argmax(shared, axis=1).astype(np.int32)
    for face in np.flatnonzero(shared.sum(axis=1) > 1):
        candidates = np.flatnonzero(shared[face])
        corners = points[faces[face]]
        center = np.repeat(corners.mean(axis=0)[None], len(candidates), axis=0)
        normal = np.cross(corners[2] - corners[0], corners[-1] - corners[1])
        along = model.normals(candidates, center, model.initial) @ normal
        surface[face] = candidates[np.argmax(along)]
    return surface


def _bits(count):
    return 1 << np.arange(count, dtype=np.int64)


def _code(surfaces):
    return sum(1 << int(surface) for surface in surfaces)
