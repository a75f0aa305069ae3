// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Quality/ScaledJacobian.h"

class vtkUnstructuredGrid;

/// The second output of every morphing filter.
namespace morph::filters::BadCells
{
/// Makes `output` the cells of `morphed` whose scaled Jacobian is 0 or less, and their points:
/// inverted and degenerate ones (those not measured are not among them). Arrays come along; added
/// are the cell ids `MorphCellId` and the point ids `MorphPointId`, both those of `morphed`.
/// Without such cells: no points, but the arrays. `quality`: of `morphed`.
void Extract(
  const morph::Quality& quality, vtkUnstructuredGrid* morphed, vtkUnstructuredGrid* output);
}
