// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Monitor.h"
#include "Support/Types.h"

#include <Eigen/SparseCore>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

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

/// Sums the entries of one row by their columns, in a hash table with open addressing.
class SparseRow
{
public:
  using Entry = std::pair<int, double>; ///< column and value

  SparseRow() { this->clear(); }
  void clear()
  {
    this->entries_.clear();
    this->slots_.assign(std::size_t(1) << LeastBits, None);
    this->bits_ = LeastBits;
  }
  /// Adds to the entry of this column; sums have the order of the calls. Returns whether the entry
  /// is new.
  bool add(int column, double value)
  {
    int& slot = this->slot(column);
    if (slot != None)
    {
      this->entries_[slot].second += value;
      return false;
    }
    slot = static_cast<int>(this->entries_.size());
    this->entries_.emplace_back(column, value);
    if (2 * this->entries_.size() > this->slots_.size())
    {
      this->grow();
    }
    return true;
  }
  /// In the order of the columns' first calls.
  const std::vector<Entry>& entries() const { return this->entries_; }
  /// By ascending columns; the next call has to be clear().
  const std::vector<Entry>& sorted()
  {
    std::sort(this->entries_.begin(), this->entries_.end());
    return this->entries_;
  }

private:
  static constexpr int None = -1, LeastBits = 7;

  /// The place of this column in entries_, or None where it goes.
  int& slot(int column)
  {
    std::size_t at = (static_cast<std::uint32_t>(column) * 2654435769u) >> (32 - this->bits_);
    while (this->slots_[at] != None && this->entries_[this->slots_[at]].first != column)
    {
      at = (at + 1) & (this->slots_.size() - 1);
    }
    return this->slots_[at];
  }
  void grow()
  {
    this->slots_.assign(std::size_t(1) << ++this->bits_, None);
    for (std::size_t k = 0; k < this->entries_.size(); ++k)
    {
      this->slot(this->entries_[k].first) = static_cast<int>(k);
    }
  }

  std::vector<Entry> entries_;
  std::vector<int> slots_;
  int bits_ = LeastBits;
};

/// The columns of a matrix in two parts.
struct SplitMatrix
{
  CsrMatrix inside, outside;
};

/// Assembles a matrix from its rows, with ascending columns. makeRow(i, row) adds the entries of
/// row i to an empty row; makeRow = makeRows() is made for some rows of one thread. The first
/// `inside` of the columns become one matrix, and the others another. A row is made once and by one
/// thread, so the result does not depend on threads. Throws Error where an int cannot number the
/// entries. Cost: rows wait in blocks, 12 bytes an entry, until the matrices have their size.
/// `allMade`: called before that, to free what rows are made from.
using MakeRow = std::function<void(Index i, SparseRow& row)>;
SplitMatrix assembleRows(
  Index rows, Index inside, Index columns, Monitor& monitor,
  const std::function<MakeRow()>& makeRows, const std::function<void()>& allMade = [] {});

/// Throws Error if an int cannot number the entries.
void requireEntries(Index entries);
}
