# SPDX-License-Identifier: BSD-3-Clause
"""How the methods' time grows with the number of nodes: the paper's Section 4.5, bricks of
N x 20 x 20 hexahedra stretched to twice their height. The same with a twist, since a solver that
starts from the nearest affine map has nothing to do for the stretch."""

from statistics import median

import numpy as np
from paraview import simple
from vtkmodules.vtkCommonDataModel import VTK_HEXAHEDRON

from demo_picture import producer
from Models.model_mesh import ModelMesh, vtk_points
from study_pieces import ORIGIN, origin
from study_records import RowFile
from study_series import METHODS

SIZES = tuple(range(20, 261, 10))
REPEATS = 3
LEAST_NODES = 61 * 21 * 21  # of the fit: N = 60
MOTIONS = ("stretch", "twist")
FIELDS = ("motion", "method", "n", "nodes", "prepare", "evaluate", "runs", "threads",
          *ORIGIN)


def brick(n):
    """A ModelMesh of n x 20 x 20 unit cubes."""
    shape = (21, 21, n + 1)
    z, y, x = np.meshgrid(*(np.arange(size, dtype=float) for size in shape), indexing="ij")
    points = np.stack([x, y, z], axis=-1).reshape(-1, 3)
    ids = np.arange(len(points)).reshape(shape)
    corner = [ids[k:20 + k, j:20 + j, i:n + i].ravel()
              for i, j, k in ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0),
                              (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))]
    return ModelMesh(points, np.stack(corner, axis=1), VTK_HEXAHEDRON)


def moved(points, motion):
    """Where points go: z stretched to twice its length; with "twist" also turned by up to 90
    degrees about the long axis."""
    x, y, z = points.T
    z = 2 * z
    if motion == "twist":
        angle = np.pi / 2 * x / x.max()
        y, z = (y - 10) * np.cos(angle) - (z - 20) * np.sin(angle), \
               (y - 10) * np.sin(angle) + (z - 20) * np.cos(angle)
    return np.stack([x, y, z], axis=1)


def seconds(method, rest, boundary, threads):
    """(prepare, evaluate): of a new filter."""
    proxy = getattr(simple, METHODS[method])(Input=rest, Boundary=boundary)
    proxy.Validity = "None"
    proxy.NumberOfThreads = threads
    proxy.UpdatePipeline()
    field = proxy.GetClientSideObject().GetOutputDataObject(0).GetFieldData()
    result = tuple(field.GetArray(name).GetValue(0)
                   for name in ("PrepareSeconds", "EvaluateSeconds"))
    simple.Delete(proxy)
    return result


def run(path, methods, sizes, repeats, threads, deadline):
    """Writes medians of `repeats` runs to the CSV file `path`, and resumes where an earlier call
    has stopped. Raises OutOfTime between rows."""
    file = RowFile(path, FIELDS)
    done = {(row["motion"], row["method"], int(row["n"])) for row in file.rows()}
    for n in sizes:
        missing = [(motion, method) for motion in MOTIONS for method in methods
                   if (motion, method, n) not in done]
        if not missing:
            continue
        mesh = brick(n)
        rest = producer(mesh.to_vtk())
        for motion, method in missing:
            deadline.check()
            target = mesh.to_vtk()
            target.SetPoints(vtk_points(moved(mesh.points, motion)))
            boundary = producer(target)
            found = [seconds(method, rest, boundary, threads) for _ in range(repeats)]
            prepare, evaluate = (median(values) for values in zip(*found))
            file.add((motion, method, n, len(mesh.points), prepare, evaluate, repeats, threads,
                      *origin()))
            simple.Delete(boundary)
        simple.Delete(rest)


def read(path):
    """The rows of the file, as dictionaries of texts."""
    return RowFile(path, FIELDS).rows()


def exponent(nodes, values):
    """p of values ~ nodes^p over meshes of at least N = 60, by least squares; None with fewer than
    three of them."""
    large = [(n, value) for n, value in zip(nodes, values) if n >= LEAST_NODES]
    if len(large) < 3:
        return None
    logarithms = np.log(np.array(large))
    return float(np.polyfit(logarithms[:, 0], logarithms[:, 1], 1)[0])
