// SPDX-License-Identifier: BSD-3-Clause
#include "Solvers/DenseCholesky.h"

#include "Support/Parallel.h"
#include "Support/ProgressRange.h"
#include "Support/Types.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace morph
{
namespace
{
constexpr Index Panel = 96;
constexpr Index Tile = 192;
constexpr Index TilesBetweenChecks = 64; // of some milliseconds each

/// Subtracts the panel's part from the lower triangle that begins at row and column `first`.
void updateTrailing(
  DenseMatrixRef& matrix, Index column, Index width, Index first, Monitor& monitor)
{
  const Index n = matrix.rows();
  std::vector<std::pair<Index, Index>> tiles;
  for (Index i = first; i < n; i += Tile)
  {
    for (Index j = first; j <= i; j += Tile)
    {
      tiles.emplace_back(i, j);
    }
  }
  parallelBatches(monitor, static_cast<Index>(tiles.size()), TilesBetweenChecks, 1,
    [&](Index begin, Index end)
    {
      for (Index t = begin; t < end; ++t)
      {
        const auto [i, j] = tiles[t];
        const Index rows = std::min(Tile, n - i), columns = std::min(Tile, n - j);
        matrix.block(i, j, rows, columns).noalias() -=
          matrix.block(i, column, rows, width) *
          matrix.block(j, column, columns, width).transpose();
      }
    });
}
}

bool factorizeCholesky(DenseMatrixRef matrix, Monitor& monitor)
{
  const Index n = matrix.rows();
  for (Index column = 0; column < n; column += Panel)
  {
    monitor.check();
    const Index width = std::min(Panel, n - column), below = column + width;
    const Eigen::LLT<Eigen::MatrixXd> pivot(matrix.block(column, column, width, width));
    if (pivot.info() != Eigen::Success)
    {
      return false;
    }
    matrix.block(column, column, width, width) = pivot.matrixLLT();
    const Index strips = (n - below + Tile - 1) / Tile;
    monitor.parallelFor(strips, 1,
      [&](Index begin, Index end)
      {
        for (Index s = begin; s < end; ++s)
        {
          const Index row = below + s * Tile, rows = std::min(Tile, n - row);
          auto strip = matrix.block(row, column, rows, width);
          pivot.matrixU().solveInPlace<Eigen::OnTheRight>(strip);
        }
      });
    const auto done = [n](Index columns)
    { return 1 - std::pow(1 - static_cast<double>(columns) / static_cast<double>(n), 3); };
    ProgressRange updating(monitor, done(column), done(below));
    updateTrailing(matrix, column, width, below, updating);
    updating.progress(1);
  }
  return true;
}

void solveCholesky(const Eigen::Ref<const Eigen::MatrixXd>& factor, DenseMatrixRef b)
{
  const auto lower = factor.triangularView<Eigen::Lower>();
  lower.solveInPlace(b);
  lower.transpose().solveInPlace(b);
}
}
