// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkType.h>

#include <functional>

class vtkIdList;
class vtkUnstructuredGrid;

/// Some of a grid's cells as a grid of their own.
namespace morph::filters::SubGrid
{
/// The number in the new grid of a node of the old one.
using Numbering = std::function<vtkIdType(vtkIdType node)>;

/// Appends a copy of a cell; a polyhedron's faces keep their order.
void InsertCell(
  vtkUnstructuredGrid* from, vtkIdType cell, const Numbering& numberOf, vtkUnstructuredGrid* to);

/// Makes `output` these cells with all arrays, and the arrays MorphPointId and MorphCellId with
/// their numbers in `grid`. Nodes are numbered in the order in which the cells first name them.
void Extract(vtkUnstructuredGrid* grid, vtkIdList* cells, vtkUnstructuredGrid* output);
}
