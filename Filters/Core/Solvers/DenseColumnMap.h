// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace morph
{
/// A LocalColumnMap for matrices with few columns: a table of all columns, which is faster. Use one
/// object a thread.
class DenseColumnMap
{
public:
  /// Cost: 4 bytes a column, and 4 for each in use.
  explicit DenseColumnMap(int columns)
    : index_(static_cast<std::size_t>(columns), None)
  {
  }

  /// Removes all columns. Cost: their number.
  void clear()
  {
    for (const int column : this->used_)
    {
      this->index_[column] = None;
    }
    this->used_.clear();
  }

  /// Returns the local index of `column`; a new column gets the number of columns before the call.
  int localIndex(int column)
  {
    int& index = this->index_[column];
    if (index == None)
    {
      index = static_cast<int>(this->used_.size());
      this->used_.push_back(column);
    }
    return index;
  }

private:
  static constexpr int None = -1;
  std::vector<int> index_, used_;
};
}
