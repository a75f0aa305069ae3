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
/// Approximates the inverse of a scalar matrix K over the nodes, in each of three columns. It sees
/// the whole mesh at once, where diagonal blocks see a node alone.
class NodePreconditioner
{
public:
  virtual ~NodePreconditioner() = default;
  /// Computes `to` = B `from` (#rows x 3). B is symmetric and positive definite, near K^-1.
  virtual void apply(const Points& from, Points& to, Monitor& monitor) const = 0;
  /// The diagonal of K, all positive.
  virtual double diagonal(Index row) const = 0;
  /// The number of nodes: that of the block rows of the matrix that it is for.
  virtual Index rows() const = 0;
};

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

/// The rows' upper part alone, as the matrix is symmetric.
struct BlockPattern
{
  std::vector<Index> offsets{ 0 };   ///< #rows + 1, into `columns`
  std::vector<std::int32_t> columns; ///< ascending in each row, from the diagonal on
  /// The block in its row for each contribution, in the order in which the owner adds them.
  std::vector<Index> placeOffsets{ 0 }; ///< #rows + 1, into `places`
  std::vector<std::uint16_t> places;
};

/// A symmetric positive semi-definite matrix of 3 x 3 blocks in compressed rows. Single precision
/// suffices for search directions and halves memory traffic, and so does the upper part alone.
///
/// Products work on chunks of rows. A chunk adds what its blocks give to rows of its own, and to a
/// copy of the rows after it. The copies are added in the order of the chunks, so the result does
/// not depend on threads.
class BlockCsr3f
{
public:
  /// Sets the pattern; `id` lets its owner recognize it later.
  void open(const PatternId& id, BlockPattern pattern);
  bool isOpenFor(const PatternId& id) const { return this->id_ == id.number(); }

  Index rows() const { return static_cast<Index>(this->pattern_.offsets.size()) - 1; }
  /// The column of a row's block, counted from the diagonal.
  Index column(Index row, Index block) const
  {
    return this->pattern_.columns[this->pattern_.offsets[row] + block];
  }
  Index numberOfBlocks(Index row) const
  {
    return this->pattern_.offsets[row + 1] - this->pattern_.offsets[row];
  }
  const std::uint16_t* places(Index row) const
  {
    return this->pattern_.places.data() + this->pattern_.placeOffsets[row];
  }
  /// The blocks from this row up to blocks(row + 1): nine values each, column major, in the order
  /// of the columns. The first is that of the diagonal. Each row is for one thread to write.
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
  ///
  /// `whole`: on one process, makes iterations nearly independent of the mesh's size: the
  /// preconditioner is then a step by the diagonal blocks, this one scaled to the diagonal, and a
  /// step again. An iteration takes three passes and that of `whole`. Null: none. It stops at
  /// `wholeTolerance` instead. Where the combination is not positive definite, the diagonal blocks
  /// alone start again, to `tolerance`.
  int solve(const Points& b, Points& x, double tolerance, int most, Monitor& monitor,
    const CopiedRows& copies = CopiedRows::alone(), const NodePreconditioner* whole = nullptr,
    double wholeTolerance = 1e-2) const;

private:
  struct Chunk;
  struct ChunkProduct;
  struct InverseBlock;
  class TwoLevels;

  /// Numbers the columns within the chunks, and gathers the copies of each row.
  void numberByChunks();
  std::vector<InverseBlock> inverseDiagonal(Monitor& monitor, const CopiedRows& copies) const;

  std::uint64_t id_ = 0; ///< 0: no pattern
  /// Columns are those of chunks: first its own rows, then its copies.
  BlockPattern pattern_;
  std::vector<float> values_; ///< Padding more follow, for reads of four numbers instead of three
  std::vector<Index> copyOffsets_{ 0 }; ///< #chunks + 1
  std::vector<std::int32_t> copyRow_;   ///< the row of each copy
  std::vector<std::int32_t> copiedRow_; ///< the rows with copies, ascending
  std::vector<Index> useOffsets_{ 0 };  ///< #copiedRow_ + 1
  std::vector<std::int32_t> uses_;      ///< their copies, ascending
  Index mostRows_ = 0;                  ///< of a chunk, with its copies
};
}
