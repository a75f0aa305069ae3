// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace morph
{
/// The k nearest of a set of nodes for many places at once. Exact: the k smallest by (squared
/// distance, node number), as (x - a)^2 + (y - b)^2 + (z - c)^2 is rounded, so a result depends on
/// neither threads nor on what else is asked for.
///
/// Places that follow each other along a space-filling curve share most of their neighbors. For a
/// block of them with centre m and radius r the triangle inequality gives d_k(x) <= d_k(m) + |x -
/// m|, hence one k-d tree search with radius d_k(m) + 2 r finds every neighbor of every place of
/// the block; the rest is comparing distances in a short list.
class NearestNodes
{
public:
  /// `nodes`: #nodes x 3, at least one, at most 2^31 - 1; copied. Cost: a k-d tree, O(n log n).
  explicit NearestNodes(const Points& nodes);
  ~NearestNodes();

  /// The neighbors of a place: `count` node numbers, ascending, and their squared distances.
  struct Neighbors
  {
    const std::int32_t* nodes;
    const double* squaredDistances;
    Index count;
  };
  using Visit = std::function<void(Index row, const Neighbors& neighbors)>;

  /// Calls visit(row, neighbors) for the places `x`.row(row), row = order[first] .. order[last -
  /// 1], from the calling thread alone; several threads may search at once. `order` should keep
  /// near places together (spatialOrder): any order is right, a random one slow. `k` >= 1; where
  /// there are fewer nodes all of them are neighbors.
  void search(const Points& x, const std::vector<Index>& order, Index first, Index last, Index k,
    const Visit& visit) const;

  Index size() const;

private:
  struct Implementation;
  class Run;
  std::unique_ptr<Implementation> implementation_;
};
}
