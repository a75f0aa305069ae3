// SPDX-License-Identifier: BSD-3-Clause
#include "Formats/JoinedNodes.h"

#include "Support/Lists.h"

#include <algorithm>
#include <array>

namespace morph::io
{
namespace
{
/// Nodes that are one: the first of them, and the parts that they belong to.
struct Group
{
  Index first = 0;
  std::vector<Index> parts;
};
}

std::vector<Index> joinedNodes(
  const std::vector<double>& coordinates, const std::vector<Index>& parts)
{
  const auto at = [&](Index node)
  {
    const double* x = coordinates.data() + 3 * node;
    return std::array<double, 3>{ x[0], x[1], x[2] };
  };
  std::vector<Index> result = consecutive(parts.size()), order = result;
  std::sort(order.begin(), order.end(),
    [&](Index a, Index b)
    {
      const auto x = at(a), y = at(b);
      return x != y ? x < y : a < b;
    });
  std::vector<Group> groups; // at one position
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    const Index node = order[i], part = parts[static_cast<std::size_t>(node)];
    if (i == 0 || at(order[i - 1]) != at(node))
    {
      groups.clear();
    }
    if (part < 0)
    {
      continue;
    }
    const auto group = std::find_if(groups.begin(), groups.end(),
      [&](const Group& one)
      { return std::find(one.parts.begin(), one.parts.end(), part) == one.parts.end(); });
    if (group == groups.end())
    {
      groups.push_back({ node, { part } });
      continue;
    }
    group->parts.push_back(part);
    result[static_cast<std::size_t>(node)] = group->first;
  }
  return result;
}
}
