// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/CellShape.h"
#include "Mesh/Mesh.h"

#include <vector>

namespace morph
{
/// The corners of a prism's front; none of other cells.
std::vector<Index> frontOf(const Mesh& mesh, Index cell);

/// copyCorners() of a cell as geometry reads it: one of a curved layer stands upright on its own
/// front, so that it has the front's scaled Jacobian and membrane stiffness, to whichever side the
/// layer is. Other cells are copied as they are.
void copyStanding(
  const Mesh& mesh, Index cell, const CellShape& shape, const ConstPoints& points, double* corners);

/// The cells of a curved layer at `points`, #nodes x 3, each upright on its own front, quadratic
/// ones too. Each has nodes of its own, in the order of the connectivity. Cost: a copy of the
/// cells.
Mesh standing(const Mesh& mesh, const ConstPoints& points);
}
