# SPDX-License-Identifier: BSD-3-Clause
"""Layers kept on the turning wall of a ring, beside FEMWARP's and beside a yardstick: interpolation
by inverse distances with rotations.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> pvpython keep_layers.py
Prints the largest lean of the wall-normal lines, in degrees, and the least relative height of the
first cells.
"""
import os
import unittest

import numpy as np
from paraview import servermanager, simple
from vtkmodules.numpy_interface import dataset_adapter
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import VTK_HEXAHEDRON, vtkUnstructuredGrid

FIRST, GROWTH, AROUND, HIGH, ANGLE = 1e-3, 1.2, 32, 2, np.radians(30)
LAYERS = 15


def radii():
    """From 1 to about 14."""
    r, step = [1.0], FIRST
    while r[-1] < 14:
        r.append(r[-1] + step)
        step *= GROWTH
    return np.array(r)


def ring_points():
    """#z x #around x #radii x 3."""
    t = 2 * np.pi * np.arange(AROUND) / AROUND
    z = np.linspace(0, 0.8, HIGH + 1)
    z, t, r = np.meshgrid(z, t, radii(), indexing="ij")
    return np.stack([r * np.cos(t), r * np.sin(t), z], axis=-1)


def turn(points):
    c, s = np.cos(ANGLE), np.sin(ANGLE)
    return points @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]).T


def figures(rest, moved):
    """Largest lean of the lines of the layers, and least height of the cells at the wall."""
    normal = moved[:, :, :1] * [1, 1, 0]
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    line = np.diff(moved[:, :, :LAYERS + 1], axis=2)
    along = (line * normal).sum(axis=-1)
    lean = np.degrees(np.arccos(np.clip(along / np.linalg.norm(line, axis=-1), -1, 1)))
    height = along[:, :, 0] / np.linalg.norm(rest[:, :, 1] - rest[:, :, 0], axis=-1)
    return lean.max(), height.min()


def inverse_distances(rest):
    """Luke, Collins, Blades, J. Comput. Phys. 231 (2012) 586-601: each boundary node carries the
    rigid motion of its surroundings, and weights are its area times (L / d)^3 + (alpha L / d)^5.
    """
    walls = np.concatenate([rest[:, :, 0].reshape(-1, 3), rest[:, :, -1].reshape(-1, 3)])
    inner = len(walls) // 2
    area = np.repeat([1, rest[0, 0, -1, 0]], inner)
    x = rest.reshape(-1, 3)
    length = np.linalg.norm(x - x.mean(axis=0), axis=1).max()
    shift = turn(walls) - walls
    shift[inner:] = 0
    mean = (shift * area[:, None]).sum(axis=0) / area.sum()
    alpha = max(0.1, 5 / length * np.linalg.norm(shift - mean, axis=1).max())
    moved = x.copy()
    for start in range(0, len(x), 1024):
        some = x[start:start + 1024]
        d = np.maximum(np.linalg.norm(some[:, None] - walls[None], axis=2), 1e-12)
        w = area * ((length / d) ** 3 + (alpha * length / d) ** 5)
        turned = w[:, :inner].sum(axis=1) / w.sum(axis=1)
        moved[start:start + 1024] += turned[:, None] * (turn(some) - some)
    return moved.reshape(rest.shape)


def grid(points):
    """The ring in hexahedra; nodes in the order of `points`."""
    k, j, i = np.meshgrid(np.arange(HIGH), np.arange(AROUND), np.arange(len(radii()) - 1),
                          indexing="ij")
    node = lambda dk, dj, di: ((k + dk) * AROUND + (j + dj) % AROUND) * len(radii()) + i + di
    corners = [(0, 0, 0), (0, 0, 1), (0, 1, 1), (0, 1, 0)]
    cells = np.stack([node(dk, dj, di) for dk in (0, 1) for _, dj, di in corners], axis=-1)
    cells = cells.reshape(-1, 8)
    data = dataset_adapter.WrapDataObject(vtkUnstructuredGrid())
    data.Points = points.reshape(-1, 3).copy()
    count = len(cells)
    connectivity = np.hstack([np.full((count, 1), 8), cells]).ravel()
    data.SetCells(np.full(count, VTK_HEXAHEDRON, np.uint8), 9 * np.arange(count), connectivity)
    return data.VTKObject


def morphed(rest):
    """Yields (name, moved points) of FEMWARP, with and without layers kept. Loads the plugin."""
    simple.LoadPlugin(os.environ["MESHMORPHING_PLUGIN"], remote=False, ns=globals())
    source = simple.TrivialProducer()
    source.GetClientSideObject().SetOutput(grid(rest))
    boundary = servermanager.Fetch(BoundaryDisplacement(Input=source))
    ids = vtk_to_numpy(boundary.GetCellData().GetArray("GeometryId"))
    bounds = np.array([boundary.GetCell(i).GetBounds() for i in range(len(ids))])
    sides = np.unique(ids[bounds[:, 5] - bounds[:, 4] < 0.1])
    morph = MorphMesh(Input=source, Moving="Region", Displacement="Translate, rotate, scale",
                      Validity="None", Rotation=[0, 0, np.degrees(ANGLE)], Surroundings="Stay",
                      FreeSurfaces=[f"Surface {i}" for i in sides])
    morph.Region = "Cylinder"
    morph.Region.Axis, morph.Region.Radius = [0, 0, 1], 1 + FIRST / 2
    for name, layers, stiffness in (("FEMWARP", 0, "Uniform"),
                                    ("FEMWARP, Inverse volume", 0, "Inverse volume"),
                                    (f"FEMWARP, {LAYERS} layers kept", LAYERS, "Uniform")):
        morph.KeepLayers, morph.Stiffness = layers, stiffness
        morph.UpdatePipeline()
        moved = vtk_to_numpy(servermanager.Fetch(morph).GetPoints().GetData())
        yield name, moved.reshape(rest.shape).astype(float)


class KeepLayersTests(unittest.TestCase):
    def test_ring(self):
        rest = ring_points()
        found = {name: figures(rest, moved) for name, moved in morphed(rest)}
        found["inverse distances"] = figures(rest, inverse_distances(rest))
        for name, (lean, height) in found.items():
            print(f"{name}: lean {lean:.2f} degrees, height {height:.4f}")
        lean, height = found[f"FEMWARP, {LAYERS} layers kept"]
        self.assertLess(lean, 5)
        self.assertLess(abs(height - 1), 0.03)
        yardstick, yardstick_height = found["inverse distances"]
        self.assertLess(lean, yardstick + 0.01)
        self.assertGreater(height, yardstick_height - 1e-6)
        self.assertGreater(found["FEMWARP"][0], 50)
        self.assertLess(found["FEMWARP, Inverse volume"][0], 35)


if __name__ == "__main__":
    unittest.main()
