// SPDX-License-Identifier: BSD-3-Clause
#include "Solvers/RowComponents.h"

#include "Support/Parallel.h"
#include "Support/UnionFind.h"

namespace morph
{
RowComponents rowComponents(const CsrMatrix& matrix, Monitor& monitor, const CsrMatrix& ghosts)
{
  const int rows = static_cast<int>(matrix.rows()), all = rows + static_cast<int>(ghosts.cols());
  UnionFind<int> components(all);
  parallel(rows, monitor,
    [&](Index row)
    {
      int root = static_cast<int>(row);
      for (CsrMatrix::InnerIterator entry(matrix, row); entry; ++entry)
      {
        root = components.join(root, static_cast<int>(entry.col()));
      }
      if (all == rows)
      {
        return;
      }
      for (CsrMatrix::InnerIterator entry(ghosts, row); entry; ++entry)
      {
        root = components.join(root, rows + static_cast<int>(entry.col()));
      }
    });

  RowComponents result;
  std::vector<int>& number = result.ofRow;
  number.resize(all);
  for (int row = 0; row < all; ++row)
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

Sums keepBetterGuess(const RowComponents& components, const RightHandSide& b, const Sums& bNorm2,
  const Sums& norm2, MultiVector& solution, MultiVector& residual, Monitor& monitor)
{
  const SumsMask drop = !(norm2 <= bNorm2); // also if the residual is not finite
  if (!drop.any())
  {
    return norm2;
  }
  return components.sums(b.rows(), monitor,
    [&](Index i, int component)
    {
      for (int j = 0; j < 4; ++j)
      {
        if (drop(component, j))
        {
          solution[i][j] = 0;
          residual[i][j] = b[i][j];
        }
      }
      return MultiVectorRow(residual[i].cwiseAbs2());
    });
}
}
