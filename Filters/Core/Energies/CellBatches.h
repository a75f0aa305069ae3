// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Energies/TargetMatrices.h"
#include "Mesh/SimplicialDecomposition.h"
#include "Mesh/Topology.h"
#include "Support/Simd.h"

#include <vector>

namespace morph
{
/// Cells with a free node, four of one shape side by side, so that the same formula runs on four tetrahedra at once. The last group
/// of a shape may have fewer; the lanes left over repeat its first cell, with weight 0.
class CellGroups
{
public:
  /// One tetrahedron of each cell of a group. Lanes of weight 0 count for nothing.
  struct Tetrahedra
  {
    double inverse[9][LaneCount]; ///< of the target, by columns
    double weight[LaneCount], theta[LaneCount];
    double stiffened[LaneCount]; ///< 1 or 0
  };

  /// `free`: ids of the nodes that move, in the order of the rows: fast where that keeps neighbors near, see rowOrder().
  CellGroups(const Mesh& mesh, const std::vector<Index>& free);
  /// Of the volume cells with these ids alone.
  CellGroups(const Mesh& mesh, const std::vector<Index>& free, const std::vector<Index>& cells);

  /// Tetrahedra without a free node have weight 0: nothing moves them.
  void setTargets(const TargetShapes& targets);

  Index size() const { return static_cast<Index>(this->groups_.size()); }
  Shape shape(Index group) const { return this->groups_[group].shape; }
  int cells(Index group) const { return this->groups_[group].cells; }
  Index cell(Index group, int lane) const { return this->groups_[group].cell[lane]; }
  int corners(Index group) const { return numberOfCorners(this->shape(group)); }
  /// Lane l of corner a is at a * LaneCount + l, here and in places().
  const std::int32_t* nodes(Index group) const
  {
    return this->node_.data() + this->groups_[group].firstPlace;
  }
  /// Of the group's first corner in its first cell, among all lanes of all corners.
  Index firstPlace(Index group) const { return this->groups_[group].firstPlace; }
  Index places() const { return static_cast<Index>(this->node_.size()); }
  Index groupOf(Index place) const { return this->groupOf_[place / LaneCount]; }
  /// The row of the place's node, or negative: its node is prescribed, or its lane repeats another.
  std::int32_t row(Index place) const { return this->row_[place]; }
  /// The places of each row, ascending.
  const Adjacency& uses() const { return this->uses_; }
  /// Whether a free node moves the tetrahedron of these four corners in that cell of the group.
  bool moves(Index group, int lane, const int* corner) const;

  const Tetrahedra* targets(Index group) const
  {
    return this->target_.data() + this->groups_[group].firstTarget;
  }

private:
  struct Group
  {
    Shape shape;
    int cells;
    Index cell[LaneCount]; ///< ids
    Index firstPlace, firstTarget;
  };
  void addPlaces(const Mesh& mesh, const std::vector<std::int32_t>& row, Group& group);

  std::vector<Group> groups_;
  std::vector<std::int32_t> node_, row_;
  std::vector<std::int32_t> groupOf_; ///< of each corner
  Adjacency uses_;
  std::vector<Tetrahedra> target_;
};
}
