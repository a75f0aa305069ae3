// SPDX-License-Identifier: BSD-3-Clause
#include "Solvers/DenseCholesky.h"

#include "Support/Monitor.h"
#include "Support/Parallel.h"
#include "Support/Types.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace morph
{
bool factorizeCholesky(DenseMatrixRef matrix, Monitor& monitor)
{
  constexpr Index Panel = 96, Strip = 192, StripsBetweenChecks = 8;
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
    // Strips of rows below: a long one and a short one by turns, so that threads share them evenly.
    const Index strips = (n - below + Strip - 1) / Strip;
    const auto forStrips = [&](Monitor& part, const auto& body)
    {
      parallelBatches(part, strips, StripsBetweenChecks, 1,
        [&](Index first, Index last)
        {
          for (Index s = first; s < last; ++s)
          {
            const Index row = below + Strip * (s % 2 == 0 ? s / 2 : strips - 1 - s / 2);
            body(row, std::min(Strip, n - row));
          }
        });
    };
    const auto done = [n](Index columns)
    { return 1 - std::pow(1 - static_cast<double>(columns) / static_cast<double>(n), 3); };
    ProgressRange solving(monitor, done(column), done(column)),
      updating(monitor, done(column), done(below));
    forStrips(solving,
      [&](Index row, Index rows)
      {
        auto strip = matrix.block(row, column, rows, width);
        pivot.matrixU().solveInPlace<Eigen::OnTheRight>(strip);
      });
    forStrips(updating,
      [&](Index row, Index rows)
      {
        const Index columns = row + rows - below;
        matrix.block(row, below, rows, columns).noalias() -=
          matrix.block(row, column, rows, width) *
          matrix.block(below, column, columns, width).transpose();
      });
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
