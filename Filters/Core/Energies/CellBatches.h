// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Energies/TargetMatrices.h"
#include "Mesh/SimplicialDecomposition.h"
#include "Mesh/Topology.h"
#include "Support/Lists.h"
#include "Support/Monitor.h"
#include "Support/Parallel.h"
#include "Support/Simd.h"

#include <algorithm>
#include <vector>

namespace morph
{
/// Cells with a free node in batches of four of one shape, so that a formula runs on four
/// tetrahedra at once. The last batch of a shape may have fewer cells: its spare lanes repeat the
/// first cell, and nothing counts there.
class CellBatches
{
public:
  /// The target cells of a batch, see TargetMatrices; their corners follow elsewhere.
  struct Targets
  {
    double factor[SimdWidth];
    long long included[SimdWidth]; ///< bit t: tetrahedron t counts
  };
  /// One corner of the target cells of a batch.
  struct TargetCorners
  {
    double x[3][SimdWidth];
  };

  /// `free`: ids of the nodes that move, in the order of the rows. An order that keeps neighbors
  /// near is fast, see unknownOrdering().
  CellBatches(const Mesh& mesh, const std::vector<Index>& free);
  /// Only the volume cells with the ids `cells`.
  CellBatches(const Mesh& mesh, const std::vector<Index>& free, const std::vector<Index>& cells);

  /// Tetrahedra without a free node are left out, as they are constant.
  void setTargets(const TargetMatrices& targets);

  Index size() const { return static_cast<Index>(this->batches_.size()); }
  Shape shape(Index batch) const { return this->batches_[batch].shape; }
  int cells(Index batch) const { return this->batches_[batch].cells; }
  Index cell(Index batch, int lane) const { return this->batches_[batch].cell[lane]; }
  int corners(Index batch) const { return numberOfCorners(this->shape(batch)); }
  /// Lane l of corner a is at a * SimdWidth + l, here and in places().
  const std::int32_t* nodes(Index batch) const
  {
    return this->node_.data() + this->batches_[batch].firstPlace;
  }
  /// The place of the batch's first corner in its first cell, among all lanes of all corners.
  Index firstPlace(Index batch) const { return this->batches_[batch].firstPlace; }
  Index places() const { return static_cast<Index>(this->node_.size()); }
  Index batchOf(Index place) const { return this->batchOf_[place / SimdWidth]; }
  /// The row of the place's node, or negative if the node is prescribed or the lane is a
  /// repetition.
  std::int32_t row(Index place) const { return this->row_[place]; }
  /// The places of each row, ascending.
  const Adjacency& uses() const { return this->uses_; }
  /// Whether the tetrahedron of these four corners in this lane of the batch has a free node.
  bool moves(Index batch, int lane, const int* corner) const;

  const Targets& targets(Index batch) const { return this->target_[batch]; }
  /// One for each corner of the shape.
  const TargetCorners* targetCorners(Index batch) const
  {
    return this->targetCorner_.data() + this->firstPlace(batch) / SimdWidth;
  }

private:
  struct Batch
  {
    Shape shape;
    int cells;
    Index cell[SimdWidth]; ///< ids
    Index firstPlace;
  };
  void addPlaces(const Mesh& mesh, const std::vector<std::int32_t>& row, Batch& batch);

  std::vector<Batch> batches_;
  std::vector<std::int32_t> node_, row_;
  std::vector<std::int32_t> batchOf_; ///< of each corner
  Adjacency uses_;
  std::vector<Targets> target_;             ///< of each batch
  std::vector<TargetCorners> targetCorner_; ///< as batchOf_
};

namespace detail
{
constexpr Index BatchGrain = 128;
constexpr Index BlockGrain = 4; // waking a thread takes as long as a block or more

/// Sums body(first, last, sum) over blocks of batches, in order.
template <typename Sum, typename Body>
Sum sumOfBlocks(const CellBatches& batches, Monitor& monitor, const Body& body)
{
  const Index count = batches.size();
  const Index blocks = (count + BatchGrain - 1) / BatchGrain;
  std::vector<Sum> part(blocks);
  parallel(blocks, BlockGrain, monitor,
    [&](Index b) { body(b * BatchGrain, std::min(count, (b + 1) * BatchGrain), part[b]); });
  Sum sum{};
  for (const Sum& p : part)
  {
    sum += p;
  }
  return sum;
}
}

/// Sums Body::run(batch, batches, arguments..., sum) over all batches, see Simd.h. Batches
/// are summed in fixed blocks in order, so the result does not depend on threads.
template <typename Body, typename Sum, typename... Arguments>
Sum sumOverBatches(const CellBatches& batches, Monitor& monitor, const Arguments&... arguments)
{
  return detail::sumOfBlocks<Sum>(batches, monitor,
    [&](Index first, Index last, Sum& own)
    { dispatchedFor<Body>(first, last, batches, arguments..., own); });
}

/// Sums the contributions of all batches to the rows' corners into `result`, #rows x 3.
/// Body::run(batch, batches, arguments..., parts) writes a batch's contributions to their places in
/// `parts`, whose memory is reused. Each row's sum has the order of its places.
template <typename Body, typename... Arguments>
void gatherFromBatches(const CellBatches& batches, Points& parts, Points& result, Monitor& monitor,
  const Arguments&... arguments)
{
  parts.resize(batches.places(), 3);
  monitor.parallelFor(batches.size(), detail::BatchGrain,
    [&](Index first, Index last)
    { dispatchedFor<Body>(first, last, batches, arguments..., parts); });
  gatherSum(batches.uses(), parts, result, monitor);
}
}
