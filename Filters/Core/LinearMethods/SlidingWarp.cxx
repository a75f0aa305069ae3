// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/SlidingWarp.h"

namespace morph
{
std::vector<SlidingWarp::Round> SlidingWarp::slide(const std::vector<Index>& sliding,
  const Surfaces& surfaces, const Limits& limits, Points& moved, Monitor& monitor) const
{
  const Points& rest = this->restPoints();
  std::vector<int> rowOfNode(rest.rows(), -1);
  for (std::size_t i = 0; i < this->rows().size(); ++i)
  {
    rowOfNode[this->rows()[i]] = static_cast<int>(i);
  }
  NodeSliding::Nodes nodes;
  std::vector<Index> own, indices;
  for (std::size_t i = 0; i < sliding.size(); ++i)
  {
    if (rowOfNode[sliding[i]] >= 0)
    {
      nodes.rows.push_back(rowOfNode[sliding[i]]);
      own.push_back(sliding[i]);
      indices.push_back(static_cast<Index>(i));
    }
  }
  nodes.rest = rest(own, allColumns);
  if (limits.rounds <= 0 || this->processes().all(own.empty()))
  {
    return {};
  }
  const Surfaces ofOwn = { [&](Index i, const Row& x)
    { return surfaces.directions(indices[i], x); },
    [&](Index i, const Row& x) { return surfaces.closest(indices[i], x); } };
  std::vector<Round> result;
  this->processes().together(
    [&]
    {
      const std::vector<Index>& prescribed = this->partition().prescribed;
      const Points given = moved(prescribed, allColumns) - rest(prescribed, allColumns);
      const Points b = -(this->coupling() * given);
      Points x = Points::Zero(b.rows(), 3);
      for (std::size_t i = 0; i < own.size(); ++i)
      {
        x.row(nodes.rows[i]) = moved.row(own[i]) - nodes.rest.row(static_cast<Index>(i));
      }
      result =
        NodeSliding(this->solver(), b, nodes, ofOwn, this->processes()).run(limits, x, monitor);
      for (std::size_t k = 0; !result.empty() && k < own.size(); ++k)
      {
        const auto i = static_cast<Index>(k);
        const Row displacement = x.row(nodes.rows[k]);
        if (displacement != moved.row(own[k]) - nodes.rest.row(i))
        {
          // Adding the displacement has rounded; the nearest point of a plane is on it.
          moved.row(own[k]) = ofOwn.closest(i, nodes.rest.row(i) + displacement);
        }
      }
    });
  return result;
}
}
