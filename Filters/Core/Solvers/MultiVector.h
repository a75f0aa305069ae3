// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Solvers/CsrMatrix.h"

#include <Eigen/Core>

#include <cmath>
#include <vector>

namespace morph
{
/// One row of three right-hand sides, and a zero: a matrix entry multiplies all three at once.
using MultiVectorRow = Eigen::Vector4d;
using MultiVector = std::vector<MultiVectorRow>;
/// A MultiVector in single precision: one SSE register a row.
using FloatMultiVector = std::vector<Eigen::Vector4f>;

template <typename Values>
MultiVectorRow toRow(const Values& row)
{
  return MultiVectorRow(row[0], row[1], row[2], 0);
}

/// Returns a / b per column, 0 for columns that have stopped.
inline MultiVectorRow ratio(
  const MultiVectorRow& a, const MultiVectorRow& b, const Eigen::Array4i& running)
{
  MultiVectorRow result = MultiVectorRow::Zero();
  for (int c = 0; c < 3; ++c)
  {
    if (running[c])
    {
      result[c] = a[c] / b[c];
    }
  }
  return result;
}

/// Returns the maximum of sqrt(a / b) over the three columns.
inline double largestRatio(const MultiVectorRow& a, const MultiVectorRow& b)
{
  return std::sqrt((a.array() / b.array().max(1e-300)).head<3>().maxCoeff());
}

/// Computes (A x)_i for x in double or single precision.
template <typename Vectors>
MultiVectorRow rowProduct(const CsrMatrix& A, Index i, const Vectors& x)
{
  MultiVectorRow sum = MultiVectorRow::Zero();
  const int last = A.outerIndexPtr()[i + 1];
  for (int k = A.outerIndexPtr()[i]; k < last; ++k)
  {
    sum += A.valuePtr()[k] * x[A.innerIndexPtr()[k]].template cast<double>();
  }
  return sum;
}
}
