// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Solvers/CsrMatrix.h"
#include "Support/HugePages.h"
#include "Support/Monitor.h"
#include "Support/Types.h"

#include <Eigen/Core>

#include <cmath>
#include <vector>

namespace morph
{
/// One row of four right-hand sides, or of three and a zero: a matrix entry multiplies all at once.
using MultiVectorRow = Eigen::Vector4d;
using MultiVector = std::vector<MultiVectorRow>;
/// A MultiVector in single precision: one SSE register a row.
using FloatMultiVector = std::vector<Eigen::Vector4f>;

/// Two multivectors in single precision in the memory of one in double precision, whose content is
/// lost. What is written as one kind must not be read as the other.
struct FloatHalves
{
  explicit FloatHalves(MultiVector& rows)
    : first(reinterpret_cast<Eigen::Vector4f*>(rows.data()))
    , second(first + rows.size())
  {
  }

  Eigen::Vector4f *first, *second; ///< as many rows each
};

template <typename Values>
MultiVectorRow toRow(const Values& row)
{
  return MultiVectorRow(row[0], row[1], row[2], 0);
}

/// Copies three right-hand sides, and back.
///@{
inline MultiVector toRows(const Points& columns, Monitor& monitor)
{
  auto rows = largeVector<MultiVectorRow>(static_cast<std::size_t>(columns.rows()));
  monitor.parallelFor(columns.rows(), 4096,
    [&](Index first, Index last)
    {
      for (Index i = first; i < last; ++i)
      {
        rows[i] = toRow(columns.row(i));
      }
    });
  return rows;
}
inline void fromRows(const MultiVector& rows, Points& columns, Monitor& monitor)
{
  resizeUndefined(columns, static_cast<Index>(rows.size()), 3);
  monitor.parallelFor(columns.rows(), 4096,
    [&](Index first, Index last)
    {
      for (Index i = first; i < last; ++i)
      {
        columns.row(i) = rows[i].head<3>();
      }
    });
}
///@}

/// Solves for three columns by the solver's solve() of rows. `x`: the first guess, then the result.
template <typename Solver>
auto solveColumns(const Solver& solver, const Points& b, Points& x, double tolerance,
  int maxIterations, Monitor& monitor)
{
  MultiVector rows = toRows(x, monitor);
  const auto report = solver.solve(toRows(b, monitor), rows, tolerance, maxIterations, monitor);
  fromRows(rows, x, monitor);
  return report;
}

/// Returns a / b per column, 0 for columns that have stopped.
inline MultiVectorRow ratio(
  const MultiVectorRow& a, const MultiVectorRow& b, const Eigen::Array4i& running)
{
  MultiVectorRow result = MultiVectorRow::Zero();
  for (int c = 0; c < 4; ++c)
  {
    if (running[c])
    {
      result[c] = a[c] / b[c];
    }
  }
  return result;
}

/// Returns the maximum of sqrt(a / b) over the columns.
inline double largestRatio(const MultiVectorRow& a, const MultiVectorRow& b)
{
  return std::sqrt((a.array() / b.array().max(1e-300)).maxCoeff());
}

/// Computes (A x)_i. rowProducts() is faster for many rows.
inline MultiVectorRow rowProduct(const CsrMatrix& A, Index i, const MultiVector& x)
{
  MultiVectorRow sum = MultiVectorRow::Zero();
  const int last = A.outerIndexPtr()[i + 1];
  for (int k = A.outerIndexPtr()[i]; k < last; ++k)
  {
    sum += A.valuePtr()[k] * x[A.innerIndexPtr()[k]];
  }
  return sum;
}
}
