// SPDX-License-Identifier: BSD-3-Clause
#include "Support/Lists.h"

#include "Support/Parallel.h"

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

void gatherSum(const Adjacency& places, const Points& parts, Points& result, Monitor& monitor)
{
  result.resize(static_cast<Index>(places.offsets.size()) - 1, 3);
  parallel(result.rows(), monitor,
    [&](Index row)
    {
      Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
      for (const Index* place = places.begin(row); place != places.end(row); ++place)
      {
        sum += parts.row(*place);
      }
      result.row(row) = sum;
    });
}
}
