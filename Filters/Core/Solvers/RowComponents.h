// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Solvers/CsrRows.h"
#include "Solvers/MultiVector.h"
#include "Solvers/RightHandSide.h"
#include "Support/Monitor.h"

#include <vector>

namespace morph
{
/// The connected components of a square matrix's graph: blocks that can be solved separately.
struct RowComponents
{
  Index count = 0;
  std::vector<int> ofRow; ///< numbered in the order of their first rows; empty for one component

  int of(Index row) const { return this->ofRow.empty() ? 0 : this->ofRow[row]; }
};

/// Finds the components: rows are connected if either has an entry in the other's column. Cost: one
/// pass over the matrix.
RowComponents rowComponents(const CsrRows<float>& matrix, Monitor& monitor);

/// Replaces a first guess of A x = b by 0, and its residual by b, if the residual's norm exceeds
/// that of b. This applies to each column of each component. Where b is exactly 0, so is then the
/// solution, without an iteration. `solution`, `residual`: of the guess. `bNorm2`, `norm2`: squared
/// norms of b and of the residual per column. Returns the new squared norm of the residual. Cost: a
/// comparison, and a pass over the vectors if there are several components.
MultiVectorRow keepBetterGuess(const RowComponents& components, const RightHandSide& b,
  const MultiVectorRow& bNorm2, const MultiVectorRow& norm2, MultiVector& solution,
  MultiVector& residual, Monitor& monitor);
}
