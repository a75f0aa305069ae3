// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Private/Data/GridMesh.h"

#include <vtkDoubleArray.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>

namespace morph::filters
{
/// Calls body with the grid's points, copied only where they are not double.
template <typename Body>
auto withPoints(vtkUnstructuredGrid* grid, Body&& body)
{
  vtkPoints* points = grid->GetPoints();
  if (auto* doubles = points ? vtkDoubleArray::FastDownCast(points->GetData()) : nullptr)
  {
    return body(
      Eigen::Map<const morph::Points>(doubles->GetPointer(0), doubles->GetNumberOfTuples(), 3));
  }
  return body(GridMesh::FromPoints(points));
}
}
