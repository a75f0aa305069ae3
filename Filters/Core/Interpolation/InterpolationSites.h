// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Adjacency.h"
#include "Support/Types.h"

#include <vector>

namespace morph
{
/// The distinct places of the prescribed nodes, which is what the meshless methods interpolate
/// between. Nodes within 1e-12 of the diagonal of the prescribed nodes' bounding box of each other,
/// directly or through others, are one site.
///
/// Sites are numbered by x, then y, then z of their coordinates, so neither the numbers nor the
/// coordinates depend on how the nodes are numbered; no two sites have equal coordinates, so the
/// order has no ties. A site lies at its node of smallest x, then y, then z.
class InterpolationSites
{
public:
  InterpolationSites() = default;
  /// `points`: all nodes; `ids`: the prescribed ones, at least one. Throws Error where there is
  /// none, or where the squares of the extents overflow or underflow. Cost: a sort of the ids;
  /// independent of where the nodes lie.
  InterpolationSites(const Points& points, const std::vector<Index>& ids);

  Index size() const { return this->coordinates_.rows(); }
  /// #sites x 3.
  const Points& coordinates() const { return this->coordinates_; }
  /// For each site its places in `ids`, by coordinates as the sites are, nodes at equal coordinates
  /// ascending.
  const Adjacency& prescribed() const { return this->prescribed_; }
  /// For each place in `ids` its site.
  const std::vector<Index>& siteOf() const { return this->siteOf_; }
  /// Length below which two places are one.
  double tolerance() const { return this->tolerance_; }

  /// `prescribed`: #ids x 3 values, for instance displacements. Returns #sites x 3, the mean over
  /// each site's nodes; bit for bit the node's own value where it is alone.
  Points average(const Points& prescribed) const;
  /// The adjoint of average(): adds the transposed mean of `sites` (#sites x 3) to `prescribed`
  /// (#ids x 3).
  void scatterTranspose(const Points& sites, Points& prescribed) const;
  /// Bytes kept.
  std::size_t memory() const;

private:
  Points coordinates_;
  Adjacency prescribed_;
  std::vector<Index> siteOf_;
  double tolerance_ = 0;
};
}
