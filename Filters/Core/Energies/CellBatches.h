// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Energies/TargetMatrices.h"
#include "Mesh/SimplicialDecomposition.h"
#include "Mesh/Topology.h"
#include "Support/Simd.h"

#include <vector>

namespace morph
{
/// Cells with a free node in batches of four of one shape, so that a formula runs on four
/// tetrahedra at once. The last batch of a shape may have fewer cells: its spare lanes repeat the
/// first cell with weight 0.
class CellBatches
{
public:
  /// One tetrahedron of each cell of a batch. Lanes of weight 0 have no effect.
  struct Tetrahedra
  {
    double inverse[9][SimdWidth]; ///< of the target matrix, by columns
    double weight[SimdWidth], theta[SimdWidth];
  };

  /// `free`: ids of the nodes that move, in the order of the rows. An order that keeps neighbors
  /// near is fast, see unknownOrdering().
  CellBatches(const Mesh& mesh, const std::vector<Index>& free);
  /// Only the volume cells with the ids `cells`.
  CellBatches(const Mesh& mesh, const std::vector<Index>& free, const std::vector<Index>& cells);

  /// Tetrahedra without a free node get weight 0, as they are constant.
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

  const Tetrahedra* targets(Index batch) const
  {
    return this->target_.data() + this->batches_[batch].firstTarget;
  }

private:
  struct Batch
  {
    Shape shape;
    int cells;
    Index cell[SimdWidth]; ///< ids
    Index firstPlace, firstTarget;
  };
  void addPlaces(const Mesh& mesh, const std::vector<std::int32_t>& row, Batch& batch);

  std::vector<Batch> batches_;
  std::vector<std::int32_t> node_, row_;
  std::vector<std::int32_t> batchOf_; ///< of each corner
  Adjacency uses_;
  std::vector<Tetrahedra> target_;
};
}
