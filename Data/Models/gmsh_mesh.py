# SPDX-License-Identifier: BSD-3-Clause
"""Meshes by Gmsh: tetrahedra of a solid, quadrilaterals of a footprint.

Debian 12's Gmsh is a 4.8.4 that crashes with its 2-D algorithm 8 (frontal for quadrilaterals), so
quadrilaterals are frontal triangles (algorithm 6) recombined in pairs by Blossom.
"""

import gmsh
import numpy as np
from vtkmodules.vtkCommonDataModel import VTK_TETRA

from .model_mesh import ModelMesh

_TRIANGLE, _QUADRILATERAL, _TETRAHEDRON = 2, 3, 4


def tetrahedra(build, size):
    """A ModelMesh of tetrahedra with edges near `size` in the solid that `build(gmsh.model.occ)`
    makes: frontal triangles, Delaunay tetrahedra, optimized. The same call gives the same mesh.
    Raises RuntimeError if Gmsh fails. Initializes and finalises Gmsh. Cost: about 3 s for 100,000
    tetrahedra."""
    return _run(build, size, {"Mesh.Optimize": 1, "Mesh.OptimizeThreshold": 0.5}, _read_tetrahedra)


def quadrilaterals(build, size):
    """Quadrilaterals with edges near `size` in the plane faces z = 0 that `build(gmsh.model.occ)`
    makes. Returns points (n, 2) and a list of (m, 4) node ids counterclockwise, one array for each
    face in the order of Gmsh's tags. Otherwise as tetrahedra."""
    options = {"Mesh.RecombineAll": 1, "Mesh.RecombinationAlgorithm": 1}
    return _run(build, size, options, _read_quadrilaterals)


def _run(build, size, options, read):
    gmsh.initialize(readConfigFiles=False)
    try:
        for name, value in {
            "General.Terminal": 0,
            "General.NumThreads": 1,
            "Mesh.RandomSeed": 1,
            "Mesh.Algorithm": 6,
            "Mesh.Algorithm3D": 1,
            "Mesh.MeshSizeMin": size,
            "Mesh.MeshSizeMax": size,
            **options,
        }.items():
            gmsh.option.setNumber(name, value)
        build(gmsh.model.occ)
        gmsh.model.occ.synchronize()
        return read()
    except Exception as error:
        raise RuntimeError(f"Gmsh could not mesh this geometry at size {size}: {error}") from error
    finally:
        gmsh.finalize()


def _read_points():
    gmsh.model.mesh.renumberNodes()
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    points = np.empty((len(tags), 3))
    points[tags.astype(np.int64) - 1] = coordinates.reshape(-1, 3)
    return points


def _elements(kind, corners, entity=-1):
    _, connectivity = gmsh.model.mesh.getElementsByType(kind, entity)
    return connectivity.astype(np.int64).reshape(-1, corners) - 1


def _read_tetrahedra():
    gmsh.model.mesh.generate(3)
    return ModelMesh(_read_points(), _elements(_TETRAHEDRON, 4), VTK_TETRA)


def _read_quadrilaterals():
    gmsh.model.mesh.generate(2)
    points = _read_points()[:, :2]
    left = len(_elements(_TRIANGLE, 3))
    if left:
        raise RuntimeError(f"{left} triangles were not recombined")
    faces = [_elements(_QUADRILATERAL, 4, tag) for _, tag in sorted(gmsh.model.getEntities(2))]
    return points, [_counterclockwise(points, quads) for quads in faces]


def _counterclockwise(points, quads):
    corners = points[quads]
    first, second = corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]
    clockwise = first[:, 0] * second[:, 1] < first[:, 1] * second[:, 0]
    quads[clockwise] = quads[clockwise, ::-1]
    return quads
