// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Solvers/LocalColumnMap.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace morph
{
/// A map from the columns of one matrix row to local indices, in the order of insertion. Columns
/// near those of the row before have a table, and others a LocalColumnMap. Most rows need the table
/// alone: its reads are next to each other, and take half the time of a hash map's. Use one object
/// a thread.
class ColumnMap
{
public:
  /// `columns`: of the matrix. Cost: 4 bytes a column, and at most 1 MiB.
  explicit ColumnMap(int columns)
    : width_(static_cast<std::size_t>(std::min(columns, MostWidth)))
    , lastBase_(static_cast<std::size_t>(columns) - this->width_)
    , table_(this->width_, None)
  {
  }

  /// Removes all columns. Cost: their number.
  void clear()
  {
    for (const int column : this->columns_)
    {
      const std::size_t at = this->place(column);
      if (at < this->width_)
      {
        this->table_[at] = None;
      }
    }
    if (!this->indexOfFar_.empty())
    {
      const auto first = static_cast<std::size_t>(this->columns_[0]);
      this->base_ = std::min(first - std::min(first, this->width_ / 2), this->lastBase_);
      this->far_.clear();
      this->indexOfFar_.clear();
    }
    this->columns_.clear();
  }
  /// Returns the number of distinct columns.
  int size() const { return static_cast<int>(this->columns_.size()); }
  /// Returns the column with the local index `index`.
  int column(int index) const { return this->columns_[index]; }

  /// Returns the local index of `column`; a new column gets size() before the call.
  int localIndex(int column)
  {
    const std::size_t at = this->place(column);
    if (at >= this->width_)
    {
      return this->localIndexOfFar(column);
    }
    int& index = this->table_[at];
    if (index == None)
    {
      index = this->size();
      this->columns_.push_back(column);
    }
    return index;
  }

private:
  static constexpr int None = -1, MostWidth = 1 << 18; // stays in a core's cache

  /// At least width_ for columns that the table does not have.
  std::size_t place(int column) const { return static_cast<std::size_t>(column) - this->base_; }
  int localIndexOfFar(int column)
  {
    const auto far = static_cast<std::size_t>(this->far_.localIndex(column));
    if (far == this->indexOfFar_.size())
    {
      this->indexOfFar_.push_back(this->size());
      this->columns_.push_back(column);
    }
    return this->indexOfFar_[far];
  }

  // Not of the table's type, so that the compiler keeps them in registers.
  std::size_t width_, lastBase_, base_ = 0;
  std::vector<int> table_; ///< local indices of width_ columns from base_ on
  std::vector<int> columns_;
  LocalColumnMap far_;
  std::vector<int> indexOfFar_; ///< by the index in far_
};
}
