// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Solvers/CsrMatrix.h"
#include "Solvers/MultiVector.h"
#include "Support/Types.h"

namespace morph
{
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
