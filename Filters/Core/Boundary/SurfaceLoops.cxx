// SPDX-License-Identifier: BSD-3-Clause
#include "Boundary/SurfaceLoops.h"

#include <algorithm>
#include <map>
#include <utility>

namespace morph
{
std::vector<std::vector<Index>> boundaryLoops(
  const BoundaryFaces& faces, const std::vector<Index>& some)
{
  std::map<std::pair<Index, Index>, int> uses; // directed edges
  for (Index f : some)
  {
    const Index first = faces.offsets[f], size = faces.offsets[f + 1] - first;
    for (Index k = 0; k < size; ++k)
    {
      ++uses[{ faces.connectivity[first + k], faces.connectivity[first + (k + 1) % size] }];
    }
  }
  std::map<Index, Index> next;
  for (const auto& [edge, count] : uses)
  {
    if (uses.count({ edge.second, edge.first }))
    {
      continue;
    }
    if (count > 1 || !next.emplace(edge).second)
    {
      return {};
    }
  }
  std::vector<std::vector<Index>> loops;
  while (!next.empty())
  {
    loops.emplace_back();
    for (auto step = next.begin(); step != next.end();)
    {
      const Index to = step->second;
      loops.back().push_back(step->first);
      next.erase(step);
      step = next.find(to);
      if (step == next.end() && to != loops.back().front())
      {
        return {};
      }
    }
    if (loops.back().size() < 3)
    {
      return {};
    }
  }
  return loops;
}
}
