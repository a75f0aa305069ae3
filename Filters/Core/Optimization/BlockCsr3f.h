// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Communicator.h"
#include "Support/Monitor.h"
#include "Support/Types.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace morph
{
/// Identifies the owner of a pattern: every object has a unique number, also a copy.
class PatternId
{
public:
  PatternId();
  PatternId(const PatternId&)
    : PatternId()
  {
  }
  PatternId& operator=(const PatternId&)
  {
    *this = PatternId();
    return *this;
  }
  PatternId(PatternId&&) = default;
  PatternId& operator=(PatternId&&) = default;

  std::uint64_t number() const { return this->number_; }

private:
  std::uint64_t number_;
};

struct BlockPattern
{
  std::vector<Index> offsets{ 0 };   ///< #rows + 1, into `columns`
  std::vector<std::int32_t> columns; ///< ascending in each row, including the diagonal
  /// The block in its row for each contribution, in the order in which the owner adds them; -1 to
  /// skip it.
  std::vector<Index> placeOffsets{ 0 }; ///< #rows + 1, into `places`
  std::vector<std::int32_t> places;
};

/// A symmetric positive semi-definite matrix of 3 x 3 blocks in compressed rows, with both
/// triangles. Single precision suffices for search directions and halves memory traffic.
class BlockCsr3f
{
public:
  /// Sets the pattern; `id` lets its owner recognise it later.
  void open(const PatternId& id, BlockPattern pattern);
  bool isOpenFor(const PatternId& id) const { return this->id_ == id.number(); }

  Index rows() const { return static_cast<Index>(this->pattern_.offsets.size()) - 1; }
  const std::int32_t* columns(Index row) const
  {
    return this->pattern_.columns.data() + this->pattern_.offsets[row];
  }
  const std::int32_t* places(Index row) const
  {
    return this->pattern_.places.data() + this->pattern_.placeOffsets[row];
  }
  /// The blocks from this row up to blocks(row + 1): nine values each, column major, in the order
  /// of the columns. Each row is for one thread to write.
  float* blocks(Index row) { return this->values_.data() + 9 * this->pattern_.offsets[row]; }
  const float* blocks(Index row) const
  {
    return this->values_.data() + 9 * this->pattern_.offsets[row];
  }

  void setZero() { std::fill(this->values_.begin(), this->values_.end(), 0.f); }

  void multiply(const Points& x, Points& y, Monitor& monitor) const;

  /// Solves A x = b from x = 0 by conjugate gradients, preconditioned by the inverse diagonal
  /// blocks. It stops when the residual's norm is `tolerance` times that of b, after `most`
  /// iterations, or at a direction without positive curvature. Returns the number of iterations.
  /// On several processes A is the sum of their matrices, and b and x have the same values at all
  /// copies of a row. Cost: one pass over the blocks an iteration, and a sum over copies.
  int solve(const Points& b, Points& x, double tolerance, int most, Monitor& monitor,
    const CopiedRows& copies = CopiedRows::alone()) const;

private:
  std::uint64_t id_ = 0; ///< 0: no pattern
  BlockPattern pattern_;
  std::vector<float> values_; ///< Padding more follow, for reads of four numbers instead of three
};
}
