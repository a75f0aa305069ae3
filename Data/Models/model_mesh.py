# SPDX-License-Identifier: BSD-3-Clause
"""A volume mesh of one linear cell type as numpy arrays, and its way to VTK and to a file."""

from dataclasses import dataclass

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import (
    VTK_HEXAHEDRON,
    VTK_TETRA,
    vtkCellArray,
    vtkUnstructuredGrid,
)
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

# Faces by the cell's corner numbers, in VTK's order.
_FACES = {
    VTK_TETRA: ((0, 1, 3), (1, 2, 3), (2, 0, 3), (0, 2, 1)),
    VTK_HEXAHEDRON: (
        (0, 4, 7, 3), (1, 2, 6, 5), (0, 1, 5, 4), (3, 7, 6, 2), (0, 3, 2, 1), (4, 5, 6, 7),
    ),
}


@dataclass
class ModelMesh:
    """points: (#nodes, 3) float64; cells: (#cells, corners of a cell) int64 node ids in VTK's
    order; cell_type: VTK_HEXAHEDRON or VTK_TETRA."""

    points: np.ndarray
    cells: np.ndarray
    cell_type: int

    def boundary_faces(self):
        """(#faces, 3 or 4) node ids of the faces that belong to one cell alone, seen from outside
        counterclockwise. Cost: one sort of all faces."""
        faces = np.concatenate([self.cells[:, face] for face in _FACES[self.cell_type]])
        keys = np.sort(faces, axis=1)
        _, first, count = np.unique(keys, axis=0, return_index=True, return_counts=True)
        return faces[np.sort(first[count == 1])]

    def to_vtk(self, points=None):
        """A vtkUnstructuredGrid with its own copy of the arrays and double points: the mesh's own,
        or those given."""
        count, corners = self.cells.shape
        connectivity = np.ascontiguousarray(self.cells, dtype=np.int64).ravel()
        cells = vtkCellArray()
        cells.SetData(
            numpy_to_vtkIdTypeArray(np.arange(count + 1, dtype=np.int64) * corners, deep=1),
            numpy_to_vtkIdTypeArray(connectivity, deep=1),
        )
        grid = vtkUnstructuredGrid()
        grid.SetPoints(vtk_points(self.points if points is None else points))
        grid.SetCells(self.cell_type, cells)
        return grid


def vtk_points(points):
    """vtkPoints in double precision with its own copy of `points`, (n, 3)."""
    result = vtkPoints()
    result.SetData(numpy_to_vtk(np.ascontiguousarray(points, dtype=np.float64), deep=1))
    return result


def add_array(attributes, name, values):
    """Adds a named copy of `values` to point, cell or field data."""
    array = numpy_to_vtk(np.ascontiguousarray(values), deep=1)
    array.SetName(name)
    attributes.AddArray(array)


def read_mesh(path):
    """The ModelMesh in a .vtu of one cell type, hexahedra or tetrahedra. Raises FileNotFoundError,
    or ValueError for a file of another kind."""
    if not path.is_file():
        raise FileNotFoundError(f"there is no mesh {path}")
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    grid = reader.GetOutput()
    types = np.unique(vtk_to_numpy(grid.GetCellTypesArray())) if grid.GetNumberOfCells() else []
    if len(types) != 1 or types[0] not in _FACES:
        raise ValueError(f"{path} holds cells of types {list(types)}: one of hexahedra (12) or"
                         " tetrahedra (10) alone is needed")
    cells = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).astype(np.int64)
    points = vtk_to_numpy(grid.GetPoints().GetData()).astype(np.float64)
    corners = max(max(face) for face in _FACES[types[0]]) + 1
    return ModelMesh(points, cells.reshape(-1, corners), int(types[0]))
