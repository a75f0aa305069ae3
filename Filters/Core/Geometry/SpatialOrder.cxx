// SPDX-License-Identifier: BSD-3-Clause
#include "Geometry/SpatialOrder.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace morph
{
namespace
{
constexpr int Bits = 21; // three of them fill 63 bits

/// Moves bit i of a 21-bit number to bit 3 i.
std::uint64_t spread(std::uint64_t x)
{
  x = (x | x << 32) & 0x001f00000000ffffull;
  x = (x | x << 16) & 0x001f0000ff0000ffull;
  x = (x | x << 8) & 0x100f00f00f00f00full;
  x = (x | x << 4) & 0x10c30c30c30c30c3ull;
  x = (x | x << 2) & 0x1249249249249249ull;
  return x;
}
}

std::vector<Index> spatialOrder(const Points& points, const std::vector<Index>& ids)
{
  if (ids.empty())
  {
    return {};
  }
  Eigen::RowVector3d low = points.row(ids[0]), high = low;
  for (Index id : ids)
  {
    low = low.cwiseMin(points.row(id));
    high = high.cwiseMax(points.row(id));
  }
  const double extent = (high - low).maxCoeff();
  const double scale = extent > 0 ? ((1 << Bits) - 1) / extent : 0;

  std::vector<std::pair<std::uint64_t, Index>> keys;
  keys.reserve(ids.size());
  for (Index id : ids)
  {
    std::uint64_t key = 0;
    for (int j = 0; j < 3; ++j)
    {
      key |= spread(static_cast<std::uint64_t>((points(id, j) - low[j]) * scale)) << j;
    }
    keys.emplace_back(key, id);
  }
  // Nodes in one step are ordered by coordinates: any other order would depend on the numbering.
  std::stable_sort(keys.begin(), keys.end(),
    [&points](const auto& a, const auto& b)
    {
      if (a.first != b.first)
      {
        return a.first < b.first;
      }
      const double *p = points.data() + 3 * a.second, *q = points.data() + 3 * b.second;
      return std::lexicographical_compare(p, p + 3, q, q + 3);
    });
  std::vector<Index> order;
  order.reserve(ids.size());
  for (const auto& key : keys)
  {
    order.push_back(key.second);
  }
  return order;
}
}
