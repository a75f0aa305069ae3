// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Solvers/CsrMatrix.h"
#include "Support/Monitor.h"
#include "Support/Parallel.h"
#include "Support/Simd.h"
#include "Support/Types.h"

#include <Eigen/Core>

#include <type_traits>
#include <vector>

namespace morph
{
/// One row of four right-hand sides, or of three and a zero: a matrix entry multiplies all at once.
using MultiVectorRow = Eigen::Vector4d;
using MultiVector = std::vector<MultiVectorRow>;
/// A MultiVector in single precision: one SSE register a row.
using FloatMultiVector = std::vector<Eigen::Vector4f>;

template <typename Values>
MultiVectorRow toRow(const Values& row)
{
  return MultiVectorRow(row[0], row[1], row[2], 0);
}

/// Copies three right-hand sides, and back.
///@{
inline MultiVector toRows(const Points& columns, Monitor& monitor)
{
  MultiVector rows(columns.rows());
  parallel(columns.rows(), monitor, [&](Index i) { rows[i] = toRow(columns.row(i)); });
  return rows;
}
inline void fromRows(const MultiVector& rows, Points& columns, Monitor& monitor)
{
  columns.resize(static_cast<Index>(rows.size()), 3);
  parallel(columns.rows(), monitor, [&](Index i) { columns.row(i) = rows[i].head<3>(); });
}
///@}

namespace detail
{
MORPH_SIMD_INLINE void read(const float* x, SimdFloat4& row)
{
  row = load(x);
}
MORPH_SIMD_INLINE void read(const float* x, SimdDouble4& row)
{
  row = widened(x);
}
MORPH_SIMD_INLINE void read(const double* x, SimdDouble4& row)
{
  row = load(x);
}
}

/// Returns the sum of A's entries in [first, last), all or a part of one row's, each times the row
/// of x for its column. `x`: MultiVectorRow or Eigen::Vector4f, the latter alone for floats. Four
/// sums hide the latency of an addition. They are added as (0 + 2) + (1 + 3), and then the entries
/// that are left.
template <typename Number, typename Row>
Eigen::Matrix<Number, 4, 1> rowSum(const CsrRows<Number>& A, Index first, Index last, const Row* x)
{
  using Vector = std::conditional_t<std::is_same_v<Number, float>, SimdFloat4, SimdDouble4>;
  const auto rowAt = [&](Index k) { return x[A.column[k]].data(); };
  // Written out: GCC 12 leaves a loop over the sums as one, and keeps them in memory.
  Vector sum0 = {}, sum1 = {}, sum2 = {}, sum3 = {}, row;
  Index k = first;
  for (; last - k > 3; k += 4)
  {
    detail::read(rowAt(k), row);
    sum0 += A.value[k] * row;
    detail::read(rowAt(k + 1), row);
    sum1 += A.value[k + 1] * row;
    detail::read(rowAt(k + 2), row);
    sum2 += A.value[k + 2] * row;
    detail::read(rowAt(k + 3), row);
    sum3 += A.value[k + 3] * row;
  }
  sum0 = (sum0 + sum2) + (sum1 + sum3);
  for (; k < last; ++k)
  {
    detail::read(rowAt(k), row);
    sum0 += A.value[k] * row;
  }
  Eigen::Matrix<Number, 4, 1> sum;
  store(sum0, sum.data());
  return sum;
}

/// The right-hand side b of A x = b, row by row. It refers to its arrays, which must outlive it.
class RightHandSide
{
public:
  /// b itself.
  RightHandSide(const MultiVector& rows) // NOLINT(google-explicit-constructor)
    : vectors_(rows)
    , rows_(static_cast<Index>(rows.size()))
  {
  }
  /// b = -C u, computed when it is read. Rows next to the boundary alone have entries in C, so this
  /// takes less time than to store b.
  RightHandSide(const CsrMatrix& C, const MultiVector& u)
    : vectors_(u)
    , coupling_(C)
    , rows_(C.rows())
  {
  }

  Index rows() const { return this->rows_; }
  MultiVectorRow operator[](Index i) const
  {
    const CsrRows<double>& C = this->coupling_;
    return C.start ? MultiVectorRow(-rowSum(C, C.start[i], C.start[i + 1], this->vectors_.data()))
                   : this->vectors_[i];
  }

private:
  const MultiVector& vectors_;
  CsrRows<double> coupling_;
  Index rows_;
};
}
