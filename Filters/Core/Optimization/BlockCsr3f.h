// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Monitor.h"
#include "Support/Types.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// Tells the patterns of different owners apart: each object has a number of its own, a copy too.
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
  std::vector<std::int32_t> columns; ///< ascending in each row, the diagonal among them
  /// Where in its row each contribution goes, in the order in which the owner adds them; -1 for
  /// nowhere.
  std::vector<Index> placeOffsets{ 0 }; ///< #rows + 1, into `places`
  std::vector<std::int32_t> places;
};

/// A symmetric positive semi-definite matrix of 3 x 3 blocks in compressed rows, both triangles, in
/// single precision: it only gives directions of search, and half the bytes are half the time.
class BlockCsr3f
{
public:
  /// `id`: the owner's, by which it later recognises its pattern.
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
  /// Nine values a block, column major, in the order of the columns; up to blocks(row + 1). Each
  /// row is for one thread to write.
  float* blocks(Index row) { return this->values_.data() + 9 * this->pattern_.offsets[row]; }
  const float* blocks(Index row) const
  {
    return this->values_.data() + 9 * this->pattern_.offsets[row];
  }

  /// The owner's, kept from one filling of the matrix to the next.
  std::vector<float>& scratch() { return this->scratch_; }

  void multiply(const Points& x, Points& y, Monitor& monitor) const;

  /// Conjugate gradients for A x = b from x = 0, preconditioned by the inverses of the diagonal
  /// blocks, until the residual's norm is `tolerance` times that of b, or `most` iterations. Where
  /// a direction has no positive curvature what was found so far is the result. Returns the
  /// iterations. Cost: one pass over the blocks an iteration.
  int solve(const Points& b, Points& x, double tolerance, int most, Monitor& monitor) const;

  std::size_t memory() const;

private:
  std::uint64_t id_ = 0; ///< 0: of no pattern
  BlockPattern pattern_;
  std::vector<float> scratch_;
  std::vector<float> values_; ///< and Padding more, for reads of four numbers where three are meant
};
}
