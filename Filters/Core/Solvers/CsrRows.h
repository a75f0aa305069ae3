// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Monitor.h"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace morph
{
/// A sparse matrix in compressed rows that owns its arrays or refers to another matrix's. Columns
/// of a row may have any order.
template <typename Scalar>
struct CsrRows
{
  using Values = Eigen::Array<Scalar, Eigen::Dynamic, 1>;
  int rows = 0;
  const int* start = nullptr; ///< #rows + 1
  const int* column = nullptr;
  const Scalar* value = nullptr;
  std::vector<int> ownStart;
  // Eigen does not initialise its arrays: each thread is the first to touch its part.
  Eigen::ArrayXi ownColumn;
  Values ownValue;

  std::size_t entries() const { return this->start ? this->start[this->rows] : 0; }
  /// Refers to the own arrays.
  void adopt()
  {
    this->start = this->ownStart.data();
    this->column = this->ownColumn.data();
    this->value = this->ownValue.data();
  }
};

/// Returns the transpose of A, which has `columns` columns. Cost: two passes over the entries.
CsrRows<float> transpose(const CsrRows<float>& A, int columns);

/// Returns A B in double precision; B has `columns` columns. The result does not depend on threads.
/// Throws Error if an int cannot number its entries. Cost: the products.
///@{
CsrRows<double> product(
  const CsrRows<double>& A, const CsrRows<float>& B, int columns, Monitor& monitor);
CsrRows<double> product(
  const CsrRows<float>& A, const CsrRows<double>& B, int columns, Monitor& monitor);
///@}
}
