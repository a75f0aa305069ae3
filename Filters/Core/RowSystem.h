// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Monitor.h"
#include "NodePartition.h"
#include "SparseSolver.h"

#include <vector>

namespace morph
{
/// What methods that solve A_I U_I = -A_B U_B share. `rows`: the node id of each matrix row, see RowOrder.h.

/// Throws Error unless the tolerance lies in (0, 1).
void requireTolerance(double tolerance);

/// #rows x 3, the positions of the rows' nodes.
Points rowPositions(const Points& points, const std::vector<Index>& rows);

/// `rhs` becomes -A_B U_B; `x`, the first guess, the affine displacement nearest to that of the prescribed nodes: affine
/// motions solve the equations, so what remains of the others is all an iteration has to find. Both #rows x 3.
void startSystem(const Points& points, const std::vector<Index>& rows,
  const NodePartition& partition, const SparseMatrix& coupling, const Points& prescribed,
  Points& rhs, Points& x, Monitor& monitor);

/// From NodePartition::free's order to that of the rows, and back; #free x 3.
///@{
Points toRows(const Points& free, const std::vector<Index>& rows, const NodePartition& partition);
void fromRows(const Points& x, const std::vector<Index>& rows, const NodePartition& partition,
  Points& free, Monitor& monitor);
///@}
}
