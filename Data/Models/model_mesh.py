# SPDX-License-Identifier: BSD-3-Clause
"""A volume mesh of one linear cell type as numpy arrays, and its way to VTK and to a file."""

from dataclasses import dataclass

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import (
    VTK_HEXAHEDRON,
    VTK_TETRA,
    vtkCellArray,
    vtkUnstructuredGrid,
)
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

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

    def boundary_nodes(self):
        """Sorted ids of the nodes on faces that belong to one cell alone. Cost: one sort of all
        faces."""
        faces = np.concatenate([self.cells[:, face] for face in _FACES[self.cell_type]])
        keys = np.sort(faces, axis=1)
        _, first, count = np.unique(keys, axis=0, return_index=True, return_counts=True)
        return np.unique(faces[first[count == 1]])

    def to_vtk(self):
        """A vtkUnstructuredGrid with its own copy of the arrays and double points."""
        count, corners = self.cells.shape
        connectivity = np.ascontiguousarray(self.cells, dtype=np.int64).ravel()
        cells = vtkCellArray()
        cells.SetData(
            numpy_to_vtkIdTypeArray(np.arange(count + 1, dtype=np.int64) * corners, deep=1),
            numpy_to_vtkIdTypeArray(connectivity, deep=1),
        )
        points = vtkPoints()
        points.SetData(numpy_to_vtk(np.ascontiguousarray(self.points, dtype=np.float64), deep=1))
        grid = vtkUnstructuredGrid()
        grid.SetPoints(points)
        grid.SetCells(self.cell_type, cells)
        return grid


def write_grid(grid, path):
    """Writes a vtkUnstructuredGrid as compressed .vtu. Raises OSError where the file cannot be
    written."""
    writer = vtkXMLUnstructuredGridWriter()
    # Appended data, VTK's default, cannot be read back by VTK 9.2 with an expat that defers
    # parsing, as Debian 12's does (https://gitlab.kitware.com/vtk/vtk/-/issues/19258).
    writer.SetDataModeToBinary()
    writer.SetFileName(str(path))
    writer.SetInputData(grid)
    if writer.Write() != 1 or writer.GetErrorCode() != 0:
        raise OSError(f"cannot write {path}: VTK error code {writer.GetErrorCode()}")
