# SPDX-License-Identifier: BSD-3-Clause
"""Six kinds of mesh at about the same number of nodes, and the motion of their boundaries."""

import sys
from pathlib import Path

import numpy as np
from vtkmodules.vtkCommonDataModel import VTK_HEXAHEDRON, VTK_TETRA

ROOT = Path(__file__).resolve().parent.parent.parent
sys.path[:0] = [str(ROOT / folder) for folder in ("Data", "Testing/ParaView", "Utilities")]
import Models  # noqa: E402  (needs the path above)
from Models.model_mesh import ModelMesh  # noqa: E402
from Models.structured import around_axis  # noqa: E402

TWIST = np.pi / 2
FIRST_LAYER = 1e-4  # of the box
THICKNESS = 0.02  # of the pipe, of its radius
SHIFT = 0.15  # of inner nodes, of an edge


def twisted(points):
    """The points turned about the vertical line through the middle of their box, by 0 at its
    bottom and a right angle at its top."""
    low, high = points.min(axis=0), points.max(axis=0)
    x, y, z = (points - (low + high) / 2).T
    angle = TWIST * (z / (high - low)[2] + 0.5)
    turned = np.stack([x * np.cos(angle) - y * np.sin(angle),
                       x * np.sin(angle) + y * np.cos(angle), z], axis=1)
    return turned + (low + high) / 2


def grid(sides):
    """(points of unit boxes, ids by (z, y, x)) of a structured grid."""
    z, y, x = np.meshgrid(*(np.arange(n + 1.0) for n in reversed(sides)), indexing="ij")
    return np.stack([x, y, z], axis=-1).reshape(-1, 3), np.arange(x.size).reshape(x.shape)


def corners(ids):
    """(#boxes, 2, 2, 2): the corners of each box by (z, y, x)."""
    shape = [n - 1 for n in ids.shape]
    part = lambda first, n: slice(first, first + n)
    picked = [ids[part(k, shape[0]), part(j, shape[1]), part(i, shape[2])].ravel()
              for k in (0, 1) for j in (0, 1) for i in (0, 1)]
    return np.stack(picked, axis=1).reshape(-1, 2, 2, 2)


def hexahedra(side):
    points, ids = grid((side, side, side))
    at = corners(ids).reshape(-1, 8)
    return ModelMesh(points / side, at[:, (0, 1, 3, 2, 4, 5, 7, 6)], VTK_HEXAHEDRON)


def cube(nodes):
    return hexahedra(round(nodes ** (1 / 3)) - 1)


def tetrahedra(nodes):
    """Six to a box of the cube, with inner nodes shifted at random."""
    mesh = cube(nodes)
    at = mesh.cells[:, (0, 1, 3, 2, 4, 5, 7, 6)]  # bit 0: x, bit 1: y, bit 2: z
    paths = [(1, 2, 4), (2, 4, 1), (4, 1, 2), (2, 1, 4), (1, 4, 2), (4, 2, 1)]
    cells = []
    for number, (a, b, _) in enumerate(paths):
        cell = at[:, (0, a, a + b, 7)]
        cells.append(cell if number < 3 else cell[:, (0, 2, 1, 3)])  # odd paths wind backward
    inside = np.all((mesh.points > 0) & (mesh.points < 1), axis=1)
    shift = np.random.default_rng(7).uniform(-SHIFT, SHIFT, mesh.points.shape)
    edge = 1 / (round(len(mesh.points) ** (1 / 3)) - 1)
    return ModelMesh(mesh.points + edge * shift * inside[:, None], np.concatenate(cells),
                     VTK_TETRA)


def layers(nodes):
    """The cube with layers that grow from its bottom, of the height FIRST_LAYER, to its top."""
    mesh = cube(nodes)
    count = round(len(mesh.points) ** (1 / 3)) - 1
    low, high = 1.0, 3.0
    for _ in range(100):  # the sum of the layers is 1
        growth = (low + high) / 2
        tall = FIRST_LAYER * (growth ** count - 1) / (growth - 1) > 1
        low, high = (low, growth) if tall else (growth, high)
    heights = FIRST_LAYER * (growth ** np.arange(count + 1) - 1) / (growth - 1)
    points = mesh.points.copy()
    points[:, 2] = (heights / heights[-1])[np.rint(count * points[:, 2]).astype(int)]
    return ModelMesh(points, mesh.cells, VTK_HEXAHEDRON)


def pipe(nodes):
    """Of radius 1 and length 6, with four cells through a wall of THICKNESS."""
    through, length = 4, 6
    around = round((nodes / (through + 1) * 2 * np.pi / length) ** 0.5)
    along = round(nodes / (through + 1) / around) - 1
    z, r, angle = np.meshgrid(np.linspace(length, 0, along + 1),
                              np.linspace(1 - THICKNESS, 1, through + 1),
                              2 * np.pi * np.arange(around) / around, indexing="ij")
    return around_axis(np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=-1))


def canister(_):
    """Hexahedra of the paper's size."""
    return Models.get("canister").make("hex")


#: Of the polyhedra, polyDualMesh's, see openfoam.py.
KINDS = {"cube": cube, "tetrahedra": tetrahedra, "layers": layers, "pipe": pipe,
         "canister": canister, "polyhedra": None}
