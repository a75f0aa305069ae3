// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMover/BoundaryModel.h"

#include <vector>

namespace morph
{
/// A boundary by itself: its nodes are numbered from 0 on, in the order of their numbers in the
/// mesh. What moves a boundary takes as long as its nodes are many, not those of the mesh.
class LocalBoundary
{
public:
  /// Renumbers the boundary of `model`, unless it is that of the last call.
  void update(const BoundaryModel& model);

  /// The mesh's number of each node, ascending.
  const std::vector<Index>& nodes() const { return this->nodes_; }
  const Points& points() const { return this->points_; } ///< #nodes() x 3, current
  const BoundaryFaces& faces() const { return this->faces_; }
  const Classification& geometry() const { return this->geometry_; }
  const std::vector<Index>& bodyOfNode() const { return this->bodyOfNode_; }
  /// The numbers here of nodes of the boundary.
  std::vector<Index> numbersOf(const std::vector<Index>& nodes) const;

private:
  std::int64_t version_ = -1; ///< BoundaryModel::motionVersion of all of this
  std::vector<Index> nodes_;
  Points points_;
  BoundaryFaces faces_;
  Classification geometry_;
  std::vector<Index> bodyOfNode_;
  std::vector<Index> number_; ///< #nodes of the mesh, -1 inside
};
}
