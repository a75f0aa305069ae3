// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Private/Data/Version.h"

#include <vtkCellArray.h>
#include <vtkDataArray.h>
#include <vtkType.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>

namespace morph::filters
{
/// Tells whether a grid is the one that was seen last, not modified since. While a boundary is
/// dragged the mesh stays, and comparing or checking all of it would take longer than moving it.
/// As everywhere in VTK, who changes values in place calls Modified().
class Unchanged
{
public:
  bool Is(vtkUnstructuredGrid* grid) const
  {
    return grid == this->Grid && timeOf(grid) == this->Time &&
           grid->GetNumberOfPoints() == this->Points && grid->GetNumberOfCells() == this->Cells;
  }
  void See(vtkUnstructuredGrid* grid)
  {
    this->Grid = grid;
    this->Time = timeOf(grid);
    this->Points = grid->GetNumberOfPoints();
    this->Cells = grid->GetNumberOfCells();
  }

private:
  const vtkUnstructuredGrid* Grid = nullptr; ///< compared, never used
  vtkMTimeType Time = 0;
  vtkIdType Points = 0, Cells = 0;

  /// The grid's own time leaves its cells out.
  static vtkMTimeType timeOf(vtkUnstructuredGrid* grid)
  {
    vtkMTimeType time = grid->GetMTime();
    const auto add = [&time](vtkObject* part)
    { time = std::max(time, part ? part->GetMTime() : vtkMTimeType(0)); };
    add(Version::CellTypes(grid));
    if (vtkCellArray* cells = grid->GetCells())
    {
      add(cells);
      add(cells->GetOffsetsArray());
      add(cells->GetConnectivityArray());
    }
    return time;
  }
};
}
