// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

namespace morph
{
/// Numbers the different columns of one matrix row in the order of their first mention: a hash
/// table whose size is that of the longest row, not that of the matrix. One object per thread.
class RowPlaces
{
public:
  RowPlaces() { this->resize(LeastBits); }

  /// For the next row. Cost: that of the present row's columns.
  void clear()
  {
    for (const std::uint32_t at : this->used_)
    {
      this->slots_[at].column = None;
    }
    this->used_.clear();
  }
  /// How many different columns this row has.
  int size() const { return static_cast<int>(this->used_.size()); }

  /// The column that has the number `place`.
  int column(int place) const { return this->slots_[this->used_[place]].column; }

  /// The number of `column`, which becomes size() - 1 where it is new.
  int find(int column)
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
    return this->slots_[at].place;
  }

private:
  static constexpr int None = std::numeric_limits<int>::min();
  static constexpr int LeastBits = 9; // three quarters stay empty: columns seldom meet in a slot
  static constexpr std::uint32_t Fill = 4;

  struct Slot
  {
    int column = None;
    int place = 0;
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
    const int place = this->size();
    this->slots_[at] = { column, place };
    this->used_.push_back(at);
    if (Fill * this->used_.size() > this->mask_)
    {
      this->grow();
    }
    return place;
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
  std::vector<std::uint32_t> used_; ///< the slot of each place
  std::uint32_t mask_ = 0;
  int shift_ = 0;
};
}
