// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

#include <Eigen/SparseCore>

#include <cstddef>

namespace morph
{
/// Sparse matrices in compressed rows, 12 bytes an entry, or 8 in single precision.
template <typename Number>
using CsrMatrixOf = Eigen::SparseMatrix<Number, Eigen::RowMajor, int>;
using CsrMatrix = CsrMatrixOf<double>;

/// Refers to the rows of a compressed matrix, perhaps with other values for the same entries.
template <typename Number>
struct CsrRows
{
  CsrRows() = default;
  CsrRows(const CsrMatrixOf<Number>& matrix) // NOLINT(google-explicit-constructor)
    : CsrRows(matrix, matrix.valuePtr())
  {
  }
  template <typename Other>
  CsrRows(const CsrMatrixOf<Other>& matrix, const Number* values)
    : rows(matrix.rows())
    , start(matrix.outerIndexPtr())
    , column(matrix.innerIndexPtr())
    , value(values)
  {
  }

  int entries() const { return this->rows > 0 ? this->start[this->rows] : 0; }

  Index rows = 0;
  const int* start = nullptr; ///< #rows + 1
  const int* column = nullptr;
  const Number* value = nullptr;
};
}
