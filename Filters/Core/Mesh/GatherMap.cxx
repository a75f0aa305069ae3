// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/GatherMap.h"

namespace morph
{
std::vector<std::int32_t> inverseIndex(const std::vector<Index>& ids, Index nodes)
{
  std::vector<std::int32_t> place(nodes, -1);
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    place[ids[i]] = static_cast<std::int32_t>(i);
  }
  return place;
}

Adjacency gatherMap(Index places, Index rows, const std::function<Index(Index place)>& rowOf)
{
  Adjacency result;
  result.offsets.assign(rows + 1, 0);
  for (Index place = 0; place < places; ++place)
  {
    const Index row = rowOf(place);
    if (row >= 0)
    {
      ++result.offsets[row + 1];
    }
  }
  for (Index row = 0; row < rows; ++row)
  {
    result.offsets[row + 1] += result.offsets[row];
  }
  result.values.resize(result.offsets.back());
  std::vector<Index> at(result.offsets.begin(), result.offsets.end() - 1);
  for (Index place = 0; place < places; ++place)
  {
    const Index row = rowOf(place);
    if (row >= 0)
    {
      result.values[at[row]++] = place;
    }
  }
  return result;
}

void gatherSum(const Adjacency& places, const Points& parts, Points& result, Monitor& monitor)
{
  constexpr Index Grain = 1024;
  result.resize(static_cast<Index>(places.offsets.size()) - 1, 3);
  monitor.parallelFor(result.rows(), Grain,
    [&](Index first, Index last)
    {
      for (Index row = first; row < last; ++row)
      {
        Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
        for (const Index* place = places.begin(row); place != places.end(row); ++place)
        {
          sum += parts.row(*place);
        }
        result.row(row) = sum;
      }
    });
}
}
