// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace morph
{
/// Exact k nearest nodes for many places at once. All nodes as far as the k-th count, within 1e-9
/// of its distance and the rounding of the coordinates. So a result depends neither on threads nor
/// on the other places, and in a mesh with symmetries not on the choice of axes, unit and origin.
///
/// Places in sequence along a space-filling curve share most of their neighbors. For a block with
/// centre m and radius r, the triangle inequality gives d_k(x) <= d_k(m) + |x - m|. So one k-d tree
/// search with radius d_k(m) + 2 r finds all neighbors of the block's places. Each place then only
/// compares distances in that short list.
class NearestNodes
{
public:
  /// `nodes`: #nodes x 3, at least one, at most 2^31 - 1; copied. Cost: a k-d tree, O(n log n).
  explicit NearestNodes(const Points& nodes);
  ~NearestNodes();

  /// The neighbors of a place: `count` node numbers, ascending, and their squared distances. There
  /// are more than k where several are as far as the k-th.
  struct Neighbors
  {
    const std::int32_t* nodes;
    const double* squaredDistances;
    Index count;

    /// Returns the index of the nearest, the first of several.
    Index nearest() const
    {
      const double* d = this->squaredDistances;
      return std::min_element(d, d + this->count) - d;
    }
    double leastSquaredDistance() const { return this->squaredDistances[this->nearest()]; }
  };
  using Visit = std::function<void(Index row, const Neighbors& neighbors)>;

  /// Calls visit(row, neighbors) for the places `x`.row(row), row = order[first] to order[last -
  /// 1]. All calls come from the calling thread; several threads may search at once. `order` should
  /// keep near places together (spatialOrder): another order is slower, with the same results. `k`
  /// >= 1; if there are fewer nodes, all are neighbors.
  void search(const Points& x, const std::vector<Index>& order, Index first, Index last, Index k,
    const Visit& visit) const;

  /// Sets `found` to the nodes at most `radius` from `x`, ascending. Several threads may search at
  /// once. Cost: O(log n) and the nodes found.
  void within(const Eigen::RowVector3d& x, double radius, std::vector<std::int32_t>& found) const;

  Index size() const;

private:
  struct Implementation;
  class Run;
  std::unique_ptr<Implementation> implementation_;
};
}
