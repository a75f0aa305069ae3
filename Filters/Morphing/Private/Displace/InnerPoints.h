// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

#include <vector>

class vtkPolyData;
class vtkUnstructuredGrid;

/// Inner nodes of a mesh among the points of its displaced boundary.
namespace morph::filters::InnerPoints
{
/// Adds points without cells to `output`, of vtkBoundaryDisplacement. `nodes`: ids in `grid`;
/// `rest`, `moved`: #nodes x 3; `roles`: #nodes. Arrays that the grid has too get
/// its values, those that the filters add theirs, and others 0.
void Append(vtkUnstructuredGrid* grid, const std::vector<morph::Index>& nodes,
  const morph::Points& rest, const morph::Points& moved, const std::vector<signed char>& roles,
  vtkPolyData* output);
}
