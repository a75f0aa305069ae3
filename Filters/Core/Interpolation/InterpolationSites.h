// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Lists.h"
#include "Support/Monitor.h"
#include "Support/Types.h"

#include <vector>

namespace morph
{
/// The distinct positions of the prescribed nodes, between which the meshless methods interpolate.
/// Nodes are one site if a chain of distances of at most 1e-12 connects them. The unit is the
/// diagonal of the prescribed nodes' bounding box.
///
/// Sites are numbered by their coordinates x, y, z in lexicographic order, which has no ties. So
/// numbers and coordinates do not depend on the nodes' numbering. A site has the coordinates of its
/// first node in that order.
class InterpolationSites
{
public:
  InterpolationSites() = default;
  /// `points`: all nodes, #nodes x 3; `ids`: the prescribed ones, at least one. Throws Error if
  /// there is none, or if the squares of the extents overflow or underflow. Cost: a sort of the
  /// ids, for any positions.
  InterpolationSites(const Points& points, const std::vector<Index>& ids);

  Index size() const { return this->coordinates_.rows(); }
  /// Returns #sites x 3.
  const Points& coordinates() const { return this->coordinates_; }
  /// Returns for each site the indices of its nodes in `ids`, ordered by coordinates, equal ones
  /// ascending.
  const Adjacency& prescribed() const { return this->prescribed_; }
  /// Returns for each index in `ids` its site.
  const std::vector<Index>& siteOf() const { return this->siteOf_; }
  /// The length below which two positions are one site.
  double tolerance() const { return this->tolerance_; }

  /// Averages values (`prescribed`: #ids x 3, for instance displacements) over each site's nodes.
  /// Returns #sites x 3; a single node keeps its own value bit for bit.
  Points average(const Points& prescribed, Monitor& monitor) const;
  /// The adjoint of average(): adds the transposed mean of `sites` (#sites x 3) to `prescribed`
  /// (#ids x 3).
  void scatterTranspose(const Points& sites, Points& prescribed) const;

private:
  Points coordinates_;
  Adjacency prescribed_;
  std::vector<Index> siteOf_;
  double tolerance_ = 0;
};
}
