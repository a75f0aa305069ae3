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

/// A matrix in double precision that is read in single precision, in another unit. It refers to
/// the matrix's arrays. So no copy of the values is needed, which is a third of the memory.
struct ScaledRows
{
  int rows = 0;
  const int* start = nullptr; ///< #rows + 1
  const int* column = nullptr;
  const double* value = nullptr;
  double scale = 1; ///< multiplies the values

  ScaledRows() = default;
  ScaledRows(const CsrRows<double>& matrix, double scale)
    : rows(matrix.rows)
    , start(matrix.start)
    , column(matrix.column)
    , value(matrix.value)
    , scale(scale)
  {
  }

  std::size_t entries() const { return this->start ? this->start[this->rows] : 0; }
  /// The value of entry k, scaled, in single precision.
  float entry(int k) const { return static_cast<float>(this->value[k] * this->scale); }
};

/// Returns the transpose of A, which has `columns` columns. Cost: two passes over the entries.
CsrRows<float> transpose(const CsrRows<float>& A, int columns);

/// Returns R A P in double precision; P has `columns` columns. The result does not depend on
/// threads. Throws Error if an int cannot number its entries. Cost: the products R A and (R A) P.
/// No product is stored but the result: A P of a hexahedral mesh has 0.24 kB a row.
CsrRows<double> tripleProduct(const CsrRows<float>& R, const CsrRows<double>& A,
  const CsrRows<float>& P, int columns, Monitor& monitor);
}
