// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Solvers/CsrMatrix.h"
#include "Solvers/MultiVector.h"
#include "Support/Monitor.h"
#include "Support/Parallel.h"

#include <Eigen/Core>

#include <algorithm>
#include <utility>
#include <vector>

namespace morph
{
/// Numbers of a matrix's components and of the columns of vectors, #components x #columns. Each is
/// a system of its own, which is solved to its own size.
using Sums = Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using SumsMask = Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
/// The numbers of one component, for four columns.
inline Eigen::Map<const MultiVectorRow> rowOf(const Sums& sums, int component)
{
  return Eigen::Map<const MultiVectorRow>(sums.data() + 4 * component);
}

/// The connected components of a square matrix's graph: blocks that can be solved separately.
struct RowComponents
{
  Index count = 0;
  std::vector<int> ofRow; ///< numbered in the order of their first rows; empty for one component

  int of(Index row) const { return this->ofRow.empty() ? 0 : this->ofRow[row]; }

  /// Calls body(i, component) for all `rows`, perhaps in several threads.
  template <typename Body>
  void forRows(Index rows, Monitor& monitor, const Body& body) const
  {
    parallel(rows, monitor, [&](Index i) { body(i, this->of(i)); });
  }
  /// Sums body(i, component), a MultiVectorRow, by components. The rows are added in blocks of a
  /// fixed length, and these in their order, so threads cannot change the last bit.
  template <typename Body>
  Sums sums(Index rows, Monitor& monitor, const Body& body) const
  {
    std::vector<std::vector<std::pair<int, MultiVectorRow>>> parts((rows + Block - 1) / Block);
    monitor.parallelFor(static_cast<Index>(parts.size()), 1,
      [&](Index begin, Index end)
      {
        for (Index i = begin * Block; i < std::min(rows, end * Block);)
        {
          const Index block = i / Block, last = std::min(rows, (block + 1) * Block);
          const int component = this->of(i);
          MultiVectorRow sum = MultiVectorRow::Zero();
          for (; i < last && this->of(i) == component; ++i)
          {
            sum += body(i, component);
          }
          parts[block].emplace_back(component, sum);
        }
      });
    Sums total = Sums::Zero(this->count, 4);
    for (const auto& part : parts)
    {
      for (const auto& [component, sum] : part)
      {
        total.row(component) += sum.transpose().array();
      }
    }
    return total;
  }

private:
  static constexpr Index Block = 4096;
};

/// Finds the components: rows are connected if either has an entry in the other's column. `ghosts`:
/// none, or more columns, whose components follow those of the rows. Cost: one pass over the
/// matrices.
RowComponents rowComponents(
  const CsrMatrix& matrix, Monitor& monitor, const CsrMatrix& ghosts = CsrMatrix());

/// Replaces a first guess of A x = b by 0, and its residual by b, in each column of each component
/// where the residual exceeds b. Where b is exactly 0, so is then the solution, without an
/// iteration. `bNorm2`, `norm2`: squared norms of b and of the residual. Returns the residual's new
/// ones.
Sums keepBetterGuess(const RowComponents& components, const RightHandSide& b, const Sums& bNorm2,
  const Sums& norm2, MultiVector& solution, MultiVector& residual, Monitor& monitor);
}
