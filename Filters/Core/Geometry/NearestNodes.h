// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

namespace morph
{
/// The nodes near a place, by nanoflann's k-d tree. Several threads may search at once. A result
/// depends neither on the numbering of the nodes nor on other searches. Cost of a search: O(log
/// #nodes) and the nodes found.
class NearestNodes
{
public:
  /// `nodes`: #nodes x 3, at least one, at most 2^31 - 1; copied. Cost: a k-d tree, O(n log n).
  explicit NearestNodes(const Points& nodes);
  ~NearestNodes();

  /// Returns the distance of the nearest node from `x`.
  double distance(const Eigen::RowVector3d& x) const;

  /// Sets `found` to the `k` nodes nearest to `x`, ascending, and to all others as far as the k-th,
  /// to a relative 1e-9 and the rounding of coordinates: neither numbering nor axes, unit and
  /// origin decide a tie. `k` >= 1; if there are fewer nodes,
  /// all are neighbors.
  void nearest(const Eigen::RowVector3d& x, Index k, std::vector<std::int32_t>& found) const;

  /// Sets `found` to the nodes at most `radius` from `x`, ascending.
  void within(const Eigen::RowVector3d& x, double radius, std::vector<std::int32_t>& found) const;

  Index size() const;

private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};
}
