// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/SlidingWarp.h"

#include "Distributed/Methods.h"

#include <algorithm>
#include <utility>

namespace morph::distributed
{
std::vector<NodeSliding::Round> SlidingWarp::slide(const std::vector<Index>& sliding,
  const NodeSliding::Surfaces& surfaces, const NodeSliding::Limits& limits, Points& moved,
  Monitor& monitor) const
{
  const Points& rest = this->restPoints();
  const std::vector<Index>& unknowns = this->partition().free;
  NodeSliding::Nodes nodes;
  std::vector<Index> own, indices;
  for (std::size_t i = 0; i < sliding.size(); ++i)
  {
    const auto row = std::lower_bound(unknowns.begin(), unknowns.end(), sliding[i]);
    if (row != unknowns.end() && *row == sliding[i])
    {
      nodes.rows.push_back(static_cast<int>(row - unknowns.begin()));
      own.push_back(sliding[i]);
      indices.push_back(static_cast<Index>(i));
    }
  }
  nodes.rest = rest(own, allColumns);
  if (limits.rounds <= 0 || this->processes().all(own.empty()))
  {
    return {};
  }
  const NodeSliding::Surfaces ofOwn = { [&](Index i, const NodeSliding::Row& x)
    { return surfaces.directions(indices[i], x); },
    [&](Index i, const NodeSliding::Row& x) { return surfaces.closest(indices[i], x); } };
  std::vector<NodeSliding::Round> result;
  this->processes().together(
    [&]
    {
      const std::vector<Index>& prescribed = this->partition().prescribed;
      const Points b =
        -(this->coupling() * (moved(prescribed, allColumns) - rest(prescribed, allColumns)));
      Points x = Points::Zero(static_cast<Index>(unknowns.size()), 3);
      for (std::size_t i = 0; i < own.size(); ++i)
      {
        x.row(nodes.rows[i]) = moved.row(own[i]) - nodes.rest.row(static_cast<Index>(i));
      }
      result =
        NodeSliding(this->solver(), b, nodes, ofOwn, this->processes()).run(limits, x, monitor);
      for (std::size_t k = 0; !result.empty() && k < own.size(); ++k)
      {
        const auto i = static_cast<Index>(k);
        const NodeSliding::Row displacement = x.row(nodes.rows[k]);
        if (displacement != moved.row(own[k]) - nodes.rest.row(i))
        {
          moved.row(own[k]) = ofOwn.closest(i, nodes.rest.row(i) + displacement);
        }
      }
    });
  return result;
}
}
