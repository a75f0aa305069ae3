// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Solvers/CsrMatrix.h"
#include "Support/Monitor.h"
#include "Support/Parallel.h"
#include "Support/Types.h"

#include <Eigen/Core>

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

/// Computes (A x)_i. rowProducts() is faster for many rows.
inline MultiVectorRow rowProduct(const CsrMatrix& A, Index i, const MultiVector& x)
{
  MultiVectorRow sum = MultiVectorRow::Zero();
  for (CsrMatrix::InnerIterator entry(A, i); entry; ++entry)
  {
    sum += entry.value() * x[entry.col()];
  }
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
    , coupling_(&C)
    , rows_(C.rows())
  {
  }

  Index rows() const { return this->rows_; }
  MultiVectorRow operator[](Index i) const
  {
    return this->coupling_ ? MultiVectorRow(-rowProduct(*this->coupling_, i, this->vectors_))
                           : this->vectors_[i];
  }

private:
  const MultiVector& vectors_;
  const CsrMatrix* coupling_ = nullptr;
  Index rows_;
};
}
