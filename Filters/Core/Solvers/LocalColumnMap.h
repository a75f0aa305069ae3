// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

namespace morph
{
/// A hash map from the columns of one matrix row to local indices, in the order of insertion. Its
/// memory is that of the longest row, not of the matrix. Use one object a thread.
class LocalColumnMap
{
public:
  LocalColumnMap() { this->resize(LeastBits); }

  /// Removes all columns. Cost: their number.
  void clear()
  {
    for (const std::uint32_t at : this->used_)
    {
      this->slots_[at].column = None;
    }
    this->used_.clear();
  }
  /// Returns the number of distinct columns.
  int size() const { return static_cast<int>(this->used_.size()); }

  /// Returns the column with the local index `index`.
  int column(int index) const { return this->slots_[this->used_[index]].column; }

  /// Returns the local index of `column`; a new column gets size() before the call.
  int localIndex(int column)
  {
    std::uint32_t at = this->home(column);
    while (this->slots_[at].column != column)
    {
      if (this->slots_[at].column == None)
      {
        return this->insert(at, column);
      }
      at = (at + 1) & this->mask_;
    }
    return this->slots_[at].index;
  }

private:
  static constexpr int None = std::numeric_limits<int>::min();
  static constexpr int LeastBits = 9; // three quarters stay empty, so collisions are rare
  static constexpr std::uint32_t Fill = 4;

  struct Slot
  {
    int column = None;
    int index = 0;
  };

  std::uint32_t home(int column) const
  {
    return static_cast<std::uint32_t>(column) * 2654435769u >> this->shift_;
  }

  void resize(int bits)
  {
    this->slots_.assign(std::size_t(1) << bits, {});
    this->mask_ = (std::uint32_t(1) << bits) - 1;
    this->shift_ = 32 - bits;
  }

  int insert(std::uint32_t at, int column)
  {
    const int index = this->size();
    this->slots_[at] = { column, index };
    this->used_.push_back(at);
    if (Fill * this->used_.size() > this->mask_)
    {
      this->grow();
    }
    return index;
  }

  void grow()
  {
    std::vector<Slot> old;
    old.swap(this->slots_);
    this->resize(33 - this->shift_);
    for (std::uint32_t& used : this->used_)
    {
      const Slot slot = old[used];
      used = this->home(slot.column);
      while (this->slots_[used].column != None)
      {
        used = (used + 1) & this->mask_;
      }
      this->slots_[used] = slot;
    }
  }

  std::vector<Slot> slots_;
  std::vector<std::uint32_t> used_; ///< slot of each local index
  std::uint32_t mask_ = 0;
  int shift_ = 0;
};
}
