// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Quality/ScaledJacobian.h"

class vtkUnstructuredGrid;

/// The second output of every morphing filter: its inverted and degenerate cells.
namespace morph::filters::BadCells
{
/// Copies the cells of `morphed` whose scaled Jacobian is 0 or less, and their points, to `output`.
/// These are the inverted and the degenerate cells, without those not measured. Arrays are copied
/// too; the cell ids `MorphCellId` and the point ids `MorphPointId`, both of `morphed`, are added.
/// Without bad cells the output has no points, but the arrays. `quality`: of `morphed`.
void Extract(
  const morph::Quality& quality, vtkUnstructuredGrid* morphed, vtkUnstructuredGrid* output);
}
