// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Solvers/MultiVector.h"
#include "Support/Monitor.h"

#include <vector>

namespace morph
{
/// The connected components of a square matrix's graph: its blocks, which can be solved one by one.
struct RowComponents
{
  Index count = 0;
  std::vector<int> ofRow; ///< numbered in the order of their first rows; empty for one component

  int of(Index row) const { return this->ofRow.empty() ? 0 : this->ofRow[row]; }
};

/// Two rows are connected where either has an entry in the other's column. Cost: one pass over the
/// matrix.
RowComponents rowComponents(const CsrMatrix& matrix);

/// Replaces the first guess `solution` of A x = b by 0, and its residual by b, in each column of
/// each component where the residual's norm is larger than that of b. Where b is exactly 0 the
/// solution then is so too, without an iteration. `bNorm2`, `norm2`: squared norms of b and of the
/// residual per column. Returns the latter's new value. Cost: a comparison, and a pass over the
/// vectors where there are several components.
MultiVectorRow keepBetterGuess(const RowComponents& components, const Points& b,
  const MultiVectorRow& bNorm2, const MultiVectorRow& norm2, MultiVector& solution,
  MultiVector& residual, Monitor& monitor);
}
