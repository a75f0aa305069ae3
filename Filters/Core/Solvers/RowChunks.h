// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/PageArena.h"
#include "Support/Types.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace morph
{
/// Number of rows in a chunk; it does not depend on threads.
constexpr Index ChunkRows = 4096;
/// Number of chunks that share an arena, and so are freed together.
constexpr Index ChunksOfArena = 16;

inline Index chunksOf(Index rows)
{
  return (rows + ChunkRows - 1) / ChunkRows;
}

/// Some rows while they are made: their numbers of entries, and all entries.
template <typename Scalar>
struct RowsInWork
{
  std::vector<int> size, column;
  std::vector<Scalar> value;

  void clear()
  {
    this->size.clear();
    this->column.clear();
    this->value.clear();
  }
};

/// Some rows that wait until all are joined. ChunksOfArena chunks share an arena, which is freed
/// with the last of them.
template <typename Scalar>
class StoredRows
{
public:
  StoredRows() = default;
  StoredRows(const RowsInWork<Scalar>& rows, std::shared_ptr<PageArena> arena)
    : rows_(rows.size.size())
    , entries_(rows.value.size())
    , size_(arena->copy(rows.size))
    , column_(arena->copy(rows.column))
    , value_(arena->copy(rows.value))
    , arena_(std::move(arena))
  {
  }

  std::size_t entries() const { return this->entries_; }
  const Scalar* values() const { return this->value_; } ///< #entries

  /// Sets the ends of the rows in start[1], start[2], ...; start[0] is given.
  void setEnds(int* start) const
  {
    for (std::size_t i = 0; i < this->rows_; ++i)
    {
      start[i + 1] = start[i] + this->size_[i];
    }
  }

  void copyColumns(int* column) const { std::copy_n(this->column_, this->entries_, column); }
  /// Copies the entries, and lets go of the arena.
  void copyAndRelease(int* column, Scalar* value)
  {
    this->copyColumns(column);
    std::copy_n(this->value_, this->entries_, value);
    *this = {};
  }

private:
  std::size_t rows_ = 0, entries_ = 0;
  const int* size_ = nullptr;
  const int* column_ = nullptr;
  const Scalar* value_ = nullptr;
  std::shared_ptr<PageArena> arena_; // last: the constructor copies the others by it
};
}
