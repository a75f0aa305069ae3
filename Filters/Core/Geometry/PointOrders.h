// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Monitor.h"
#include "Support/Types.h"

#include <vector>

namespace morph
{
/// Points in farthest-point order: each is one that is farthest from all before it.
struct FarthestPoints
{
  std::vector<Index> order; ///< all points
  /// Of each point in `order`, its distance from the nearest of those before it. It never increases
  /// after the fourth. Of a tie it is the least.
  std::vector<double> distances;
};

/// Sorts `points`, #points x 3, in farthest-point order: the first n cover the points evenly, for
/// every n. The first four span the largest simplex found greedily: they are the farthest from the
/// mean, from the first, from the line and from the plane of those before. Of points equally far,
/// to 1e-5 of their distance, that with the least x goes first, then the least y, then the least z,
/// to 1e-6 of the extent. So neither rounding nor the numbering decides on a symmetric body. Cost:
/// O(n log n) for points spread over a surface or a volume.
///
/// Source: T. F. Gonzalez, "Clustering to minimize the maximum intercluster distance", Theoretical
/// Computer Science 38 (1985) 293-306.
FarthestPoints farthestPoints(const Points& points, Monitor& monitor);

/// Sorts `ids` along a space-filling curve (Morton's, with 2^21 steps a side). Nodes near in the
/// list are near in space, whatever their numbering. Nodes at one position keep their order in
/// `ids`. Cost: a sort.
std::vector<Index> spatialOrder(const Points& points, const std::vector<Index>& ids);
}
