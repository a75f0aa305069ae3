// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh.h"
#include "Monitor.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// A symmetric positive semi-definite matrix of 3 x 3 blocks in compressed rows, both triangles, in single precision: it only gives
/// directions of search, and half the bytes are half the time.
class BlockMatrix
{
public:
  /// `owner`: whose pattern this is; `offsets`: #rows + 1; `columns`: ascending in each row, the diagonal among them.
  void open(const void* owner, std::vector<Index> offsets, std::vector<std::int32_t> columns);
  bool isOpenFor(const void* owner) const { return this->owner_ == owner; }

  Index rows() const { return static_cast<Index>(this->offsets_.size()) - 1; }
  const std::vector<Index>& offsets() const { return this->offsets_; }
  const std::int32_t* columns(Index row) const
  {
    return this->columns_.data() + this->offsets_[row];
  }
  /// Nine values a block, row major, in the order of the columns; each row is for one thread to write.
  float* blocks(Index row) { return this->values_.data() + 9 * this->offsets_[row]; }
  const float* blocks(Index row) const { return this->values_.data() + 9 * this->offsets_[row]; }

  void multiply(const Points& x, Points& y, Monitor& monitor) const;

  /// Conjugate gradients for A x = b from x = 0, preconditioned by the inverses of the diagonal blocks, until the residual's norm is
  /// `tolerance` times that of b, or `most` iterations. Where a direction has no positive curvature what was found
  /// so far is the result. Returns the iterations. Cost: one pass over the blocks an iteration.
  int solve(const Points& b, Points& x, double tolerance, int most, Monitor& monitor) const;

  std::size_t memory() const;

private:
  const void* owner_ = nullptr;
  std::vector<Index> offsets_{ 0 };
  std::vector<std::int32_t> columns_;
  std::vector<float> values_;
};
}
