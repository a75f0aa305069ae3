# SPDX-License-Identifier: BSD-3-Clause
"""The boundaries that a series of the study is morphed to, step by step, and the cells that no
interior node can make valid."""

from typing import NamedTuple

import numpy as np
from paraview import simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import VTK_HEXAHEDRON

from demo_picture import producer
from Models.model_mesh import vtk_points
from models_folds import MovedSurfaces, output
from study_mesh import settled

#: A cell's corner and its neighbors along the edges, in an order of positive volume.
_CORNERS = {
    True: ((0, 1, 3, 4), (1, 2, 0, 5), (2, 3, 1, 6), (3, 0, 2, 7),
           (4, 7, 5, 0), (5, 4, 6, 1), (6, 5, 7, 2), (7, 6, 4, 3)),
    False: ((0, 1, 2, 3), (1, 2, 0, 3), (2, 0, 1, 3), (3, 0, 2, 1)),
}


class Boundaries(NamedTuple):
    """Boundaries step by step. positions: (n, #boundary nodes, 3) at each step. lost: for each step
    the ascending ids of cells that no interior node can make valid, since one of their faces is
    folded or a corner whose four nodes are all prescribed is inverted."""

    positions: np.ndarray
    lost: list


def times(model, steps):
    """(n,): t of each step: `steps` equal ones to S_F, and on to the end of the geometry."""
    last = int(np.floor(model.last * steps + 1e-9))
    return np.arange(last + 1) / steps


def exact_positions(mesh, ts):
    """(n, #boundary nodes, 3): the boundary on the model's true surfaces at each t."""
    return np.stack([settled(mesh.boundary_positions(t)) for t in ts])


def residual_positions(mesh, ts, relative):
    """As exact_positions, with surfaces moved after their exact curves by weighted residual, from
    S_0 or from the step before. Ends before the first step at which that gives no surface."""
    surfaces = MovedSurfaces(mesh)
    found = []
    try:
        for t in ts:
            surfaces.move_to(t, relative)
            found.append(settled(surfaces.moved[mesh.nodes]))
    except RuntimeError:
        pass
    finally:
        surfaces.remove()
    return np.stack(found)


def folded_cells(mesh, positions):
    """For each step the ids of cells with a folded boundary face.

    A face is folded where its scaled Jacobian, signed by its surface's normal, is not positive, as
    Morph Boundary measures it when all boundary nodes are given."""
    rest, moved = producer(mesh.to_vtk()), producer(mesh.boundary_to_vtk(0))
    measure = simple.MorphBoundary(Input=rest, Boundary=moved, PrescribedDimension=2)
    found = []
    for step in positions:
        boundary = mesh.boundary_to_vtk(0)
        boundary.SetPoints(vtk_points(step))
        moved.GetClientSideObject().SetOutput(boundary)
        moved.MarkModified(moved)
        measure.UpdatePipeline()
        surface = output(measure)
        quality, cells = (vtk_to_numpy(surface.GetCellData().GetArray(name))
                          for name in ("ScaledJacobian", "MorphCellId"))
        if len(cells) != len(mesh.faces):
            raise RuntimeError(f"{mesh.model.name}: Morph Boundary gave no boundary")
        found.append(np.unique(cells[~(quality > 0)]))
    for proxy in (measure, moved, rest):
        simple.Delete(proxy)
    return found


def _determined_corners(mesh):
    """The corners whose four nodes, a corner and its neighbors along the edges, are all prescribed:
    (n, 4) their node ids; (n,) their cells."""
    prescribed = np.zeros(len(mesh.points), bool)
    prescribed[mesh.nodes] = True
    table = np.array(_CORNERS[mesh.cell_type == VTK_HEXAHEDRON])
    corners = mesh.cells[:, table].reshape(-1, 4)
    cells = np.repeat(np.arange(len(mesh.cells)), len(table))
    fixed = prescribed[corners].all(axis=1)
    return corners[fixed], cells[fixed]


def _edges(points, corners):
    return [points[corners[:, k]] - points[corners[:, 0]] for k in (1, 2, 3)]


def _volumes(a, b, c):
    return np.einsum("ij,ij->i", a, np.cross(b, c))


def determined_cells(mesh, positions):
    """For each step the ids of cells with a corner whose four nodes are all prescribed and span no
    positive volume: what vtkMorphAlgorithm counts as BoundaryInvertedCells."""
    corners, cells = _determined_corners(mesh)
    points, found = mesh.points.copy(), []
    for step in positions:
        points[mesh.nodes] = step
        volumes = _volumes(*_edges(points, corners))
        found.append(np.unique(cells[~(volumes > 0)]))
    return found


def quality_limit(mesh, positions):
    """The minimum scaled Jacobian of the corners whose four nodes are all prescribed.

    No mesh with the boundary at `positions`, (#boundary nodes, 3), has a higher one."""
    corners, _ = _determined_corners(mesh)
    points = mesh.points.copy()
    points[mesh.nodes] = positions
    edges = _edges(points, corners)
    scaled = _volumes(*edges) / np.prod([np.linalg.norm(edge, axis=1) for edge in edges], axis=0)
    return scaled.min() * (1 if mesh.cell_type == VTK_HEXAHEDRON else np.sqrt(2))


def lost_cells(mesh, positions):
    """See Boundaries."""
    return [np.union1d(folded, determined) for folded, determined in
            zip(folded_cells(mesh, positions), determined_cells(mesh, positions))]


def read_boundaries(folder, series, mesh, ts):
    """Boundaries of the series, kept in the folder: positions by weighted residual in an .npy, the
    lost cells in a .csv of step and cell."""
    exact = series.surfaces == "exact"
    way = "exact" if exact else series.stepping
    name = f"boundary-{series.model}-{series.kind}-{way}-{len(mesh.nodes)}-{len(ts)}"
    if exact:
        positions = exact_positions(mesh, ts)
    else:
        positions = _kept(folder / f"{name}.npy", np.load, np.save,
                          lambda: residual_positions(mesh, ts, series.stepping == "relative"))
    pairs = _kept(folder / f"{name}-lost-cells.csv", _read_pairs, _write_pairs,
                  lambda: _pairs(lost_cells(mesh, positions)))
    return Boundaries(positions, [pairs[pairs[:, 0] == step, 1] for step in range(len(positions))])


def _kept(file, read, write, make):
    """What is in the file, or else is made. It is written under another name first, so that an
    interruption leaves no part of it."""
    if not file.is_file():
        partial = file.with_name("partial-" + file.name)
        write(partial, make())
        partial.replace(file)
    return read(file)


def _pairs(cells):
    """(n, 2): step and cell id."""
    return np.concatenate([np.column_stack([np.full(len(ids), step), ids])
                           for step, ids in enumerate(cells)]).astype(int)


def _write_pairs(file, pairs):
    np.savetxt(file, pairs, fmt="%d", delimiter=",", header="step,cell", comments="")


def _read_pairs(file):
    rows = file.read_text(encoding="utf-8").splitlines()[1:]
    return np.array([row.split(",") for row in rows], dtype=int).reshape(-1, 2)
