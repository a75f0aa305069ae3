// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

namespace morph
{
/// Numbers the different columns of one matrix row in the order of their first mention: a hash
/// table whose size is that of the longest row, not that of the matrix. One object per thread.
class RowPlaces
{
public:
  RowPlaces()
    : slots_(128)
    , mask_(this->slots_.size() - 1)
  {
  }

  /// For the next row.
  void clear()
  {
    this->row_ += RowStep;
    this->size_ = 0;
  }
  /// How many different columns this row has.
  int size() const { return this->size_; }

  /// The number of `column`, which becomes size() - 1 where it is new.
  int find(int column)
  {
    const std::uint64_t key = this->row_ | static_cast<std::uint32_t>(column);
    Slot* slot = this->slotOf(key);
    if (slot->key != key)
    {
      if (2 * static_cast<std::size_t>(this->size_) >= this->mask_)
      {
        this->grow();
        slot = this->slotOf(key);
      }
      *slot = { key, this->size_++ };
    }
    return slot->place;
  }

private:
  static constexpr std::uint64_t RowStep = std::uint64_t(1) << 32;

  struct Slot
  {
    std::uint64_t key = 0; ///< row and column; a slot of any other row than the present is empty
    int place = 0;
  };

  /// The slot that holds `key`, or the empty one where it belongs.
  Slot* slotOf(std::uint64_t key)
  {
    std::size_t at = (static_cast<std::uint32_t>(key) * 2654435769u >> 12) & this->mask_;
    while (this->slots_[at].key != key && this->slots_[at].key >= this->row_)
    {
      at = (at + 1) & this->mask_;
    }
    return &this->slots_[at];
  }

  void grow()
  {
    std::vector<Slot> old(2 * this->slots_.size());
    old.swap(this->slots_);
    this->mask_ = this->slots_.size() - 1;
    for (const Slot& slot : old)
    {
      if (slot.key >= this->row_)
      {
        *this->slotOf(slot.key) = slot;
      }
    }
  }

  std::vector<Slot> slots_;
  std::size_t mask_;
  std::uint64_t row_ = RowStep; ///< the present row's keys start here, and no key is above it
  int size_ = 0;
};
}
