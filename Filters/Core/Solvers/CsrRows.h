// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Monitor.h"
#include "Support/Types.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace morph
{
class MixedPrecisionMatrix;

/// Columns of 16 bits, for rows whose columns ascend and are near each other and the diagonal. Each
/// entry has the step from the column before it. The first one steps from before(row).
struct NarrowColumns
{
  static constexpr Index MostStep = 65535;
  static Index before(Index row) { return row - MostStep; }
};

/// A sparse matrix in compressed rows that owns its arrays or refers to another matrix's. Columns
/// of a row may have any order, unless they are narrow.
template <typename Scalar>
struct CsrRows
{
  using Values = Eigen::Array<Scalar, Eigen::Dynamic, 1>;
  int rows = 0;
  const int* start = nullptr;          ///< #rows + 1
  const int* column = nullptr;         ///< null where columns are narrow
  const std::uint16_t* step = nullptr; ///< null where not; see NarrowColumns
  const Scalar* value = nullptr;
  std::vector<int> ownStart;
  // Eigen does not initialise its arrays: each thread is the first to touch its part.
  Eigen::ArrayXi ownColumn;
  Values ownValue;

  std::size_t entries() const { return this->start ? this->start[this->rows] : 0; }
  /// Returns the bytes that a product reads, without vectors.
  double bytesRead() const
  {
    const std::size_t ofColumn = this->step ? sizeof(std::uint16_t) : sizeof(int);
    return static_cast<double>(
      (ofColumn + sizeof(Scalar)) * this->entries() + sizeof(int) * (this->rows + std::size_t(1)));
  }
  /// Refers to the own arrays.
  void adopt()
  {
    this->start = this->ownStart.data();
    this->column = this->ownColumn.data();
    this->value = this->ownValue.data();
  }
};

/// Sets `sums`, #rows, to the sums of the absolute values of the rows.
void absoluteRowSums(const CsrRows<float>& A, std::vector<float>& sums, Monitor& monitor);

/// Returns the transpose of A, which has `columns` columns. Cost: two passes over the entries.
CsrRows<float> transpose(const CsrRows<float>& A, int columns);

/// Returns R A P in double precision; P has `columns` columns. The result does not depend on
/// threads. Throws Error if an int cannot number its entries. Cost: the products R A and (R A) P.
/// No product is stored but the result: A P of a hexahedral mesh has 0.24 kB a row. Each range of
/// threads has two tables of at most 1 MiB.
///@{
CsrRows<double> tripleProduct(const CsrRows<float>& R, const CsrRows<double>& A,
  const CsrRows<float>& P, int columns, Monitor& monitor);
/// In units of A.unit().
CsrRows<double> tripleProduct(const CsrRows<float>& R, const MixedPrecisionMatrix& A,
  const CsrRows<float>& P, int columns, Monitor& monitor);
///@}
}
