// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Solvers/CsrMatrix.h"
#include "Solvers/CsrRows.h"
#include "Support/Monitor.h"
#include "Support/PageBlock.h"
#include "Support/Types.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace morph
{
struct ChunkedMatrix;

/// A sparse matrix in compressed rows that is read in single or in double precision. It keeps the
/// entries rounded to single precision, and what this leaves of their bits in another array. So a
/// preconditioner reads 8 bytes an entry and all others 12, without a copy. narrowColumns() makes
/// this 6 and 10.
///
/// Values are exact, with one exception: an entry below 2^-187 of the largest gets about this size.
/// Beside a diagonal entry that Multigrid accepts this is below rounding.
class MixedPrecisionMatrix
{
public:
  /// The largest entry has this size, to a factor of 2, in units of unit(). Entries of very
  /// different rows then have room below and above it in single precision.
  static constexpr int LargestExponent = 60;

  MixedPrecisionMatrix() = default;
  /// Copies `matrix`.
  MixedPrecisionMatrix(const CsrMatrix& matrix, Monitor& monitor);
  /// Joins the rows, and frees the chunks one by one.
  MixedPrecisionMatrix(ChunkedMatrix chunked, Monitor& monitor);
  // Copies would refer to the other's arrays. What was moved from can be assigned to, no more.
  MixedPrecisionMatrix(const MixedPrecisionMatrix&) = delete;
  MixedPrecisionMatrix& operator=(const MixedPrecisionMatrix&) = delete;
  MixedPrecisionMatrix(MixedPrecisionMatrix&&) noexcept = default;
  MixedPrecisionMatrix& operator=(MixedPrecisionMatrix&&) noexcept = default;

  Index rows() const { return this->rounded_.rows; }
  Index columns() const { return this->width_; }
  std::size_t entries() const { return this->rounded_.entries(); }

  /// The structure, and the entries in units of unit(), rounded.
  const CsrRows<float>& rounded() const { return this->rounded_; }
  /// What rounding leaves: the difference of the bits of both doubles.
  const int* rest() const { return this->rest_.data(); }
  /// A power of two.
  double unit() const { return this->unit_; }

  /// Replaces the columns by NarrowColumns where all fit, in their own memory. Functions that read
  /// CsrRows::column must not be called any more. Returns whether they fit. After an exception the
  /// matrix has no meaning.
  bool narrowColumns(Monitor& monitor);
  /// Calls use(column, k) for the entries k of a row.
  template <typename Use>
  void forRow(Index row, const Use& use) const
  {
    const CsrRows<float>& A = this->rounded_;
    Index column = NarrowColumns::before(row);
    for (int k = A.start[row]; k < A.start[row + 1]; ++k)
    {
      column = A.step ? column + A.step[k] : A.column[k];
      use(static_cast<int>(column), k);
    }
  }

  double value(int k) const { return this->unit_ * this->inUnits(k); }
  /// value() in units of unit().
  double inUnits(int k) const { return joined(this->rounded_.value[k], this->rest_[k]); }
  /// The number that a rounded entry and its rest stand for. Always inlined, for any processor.
  static inline __attribute__((always_inline)) double joined(float rounded, int rest)
  {
    double number = rounded;
    std::int64_t bits;
    std::memcpy(&bits, &number, sizeof(bits));
    bits += rest;
    std::memcpy(&number, &bits, sizeof(bits));
    return number;
  }

  /// 0 where a row has no entry.
  Eigen::VectorXd diagonal(Monitor& monitor) const;
  CsrMatrix toCsr() const;
  /// Returns the bytes that a product in double precision reads.
  double bytesRead() const;
  /// Returns the bytes in use.
  std::size_t memory() const;

private:
  /// Where the columns are made.
  int* columnsInWork() { return reinterpret_cast<int*>(this->columns_.data()); }
  /// Calls use(k, step) for the entries k of a row whose columns are not narrow.
  template <typename Use>
  void forSteps(Index row, const Use& use) const
  {
    Index before = NarrowColumns::before(row);
    this->forRow(row,
      [&](int column, int k)
      {
        use(k, column - before);
        before = column;
      });
  }
  bool columnsAreNear(Monitor& monitor) const;
  void allocate(Index rows, Index columns, Index entries, double largest);
  /// Sets the entries from k on to `count` values.
  void store(const double* value, Index count, Index k);

  CsrRows<float> rounded_; ///< its columns or steps are in columns_
  PageBlock columns_;
  Eigen::ArrayXi rest_;
  Index width_ = 0;
  double unit_ = 1;
};
}
