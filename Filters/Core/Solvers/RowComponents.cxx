// SPDX-License-Identifier: BSD-3-Clause
#include "Solvers/RowComponents.h"

#include "Support/ReproducibleSum.h"
#include "Support/UnionFind.h"

#include <algorithm>
#include <cassert>

namespace morph
{
RowComponents rowComponents(const CsrRows<float>& matrix, Monitor& monitor)
{
  constexpr Index Grain = 4096;
  assert(!matrix.step);
  const int rows = matrix.rows;
  UnionFind<int> components(rows);
  monitor.parallelFor(rows, Grain,
    [&](Index first, Index last)
    {
      for (Index row = first; row < last; ++row)
      {
        int root = static_cast<int>(row);
        for (int k = matrix.start[row]; k < matrix.start[row + 1]; ++k)
        {
          root = components.join(root, matrix.column[k]);
        }
      }
    });

  RowComponents result;
  std::vector<int>& number = result.ofRow;
  number.resize(rows);
  for (int row = 0; row < rows; ++row)
  {
    const int first = components.root(row); // the minimum row of its component
    number[row] = first == row ? static_cast<int>(result.count++) : number[first];
  }
  if (result.count < 2)
  {
    number = {};
  }
  return result;
}

MultiVectorRow keepBetterGuess(const RowComponents& components, const RightHandSide& b,
  const MultiVectorRow& bNorm2, const MultiVectorRow& norm2, MultiVector& solution,
  MultiVector& residual, Monitor& monitor)
{
  const Index rows = b.rows();
  const bool single = components.ofRow.empty();
  std::vector<MultiVectorRow> ofB(single ? 1 : components.count, bNorm2),
    ofResidual(ofB.size(), norm2);
  if (!single)
  {
    std::fill(ofB.begin(), ofB.end(), MultiVectorRow::Zero());
    std::fill(ofResidual.begin(), ofResidual.end(), MultiVectorRow::Zero());
    for (Index i = 0; i < rows; ++i)
    {
      ofB[components.ofRow[i]] += b[i].cwiseAbs2();
      ofResidual[components.ofRow[i]] += residual[i].cwiseAbs2();
    }
  }
  std::vector<Eigen::Array4i> drop(ofB.size());
  bool any = false;
  for (std::size_t c = 0; c < drop.size(); ++c)
  {
    for (int j = 0; j < 4; ++j)
    {
      drop[c][j] = !(ofResidual[c][j] <= ofB[c][j]); // also if the residual is not finite
      any = any || drop[c][j];
    }
  }
  if (!any)
  {
    return norm2;
  }
  return reproducibleSum(rows, monitor, MultiVectorRow(MultiVectorRow::Zero()),
    [&](Index i)
    {
      const Eigen::Array4i& dropped = drop[components.of(i)];
      for (int j = 0; j < 4; ++j)
      {
        if (dropped[j])
        {
          solution[i][j] = 0;
          residual[i][j] = b[i][j];
        }
      }
      return MultiVectorRow(residual[i].cwiseAbs2());
    });
}
}
