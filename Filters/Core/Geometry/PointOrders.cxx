// SPDX-License-Identifier: BSD-3-Clause
#include "Geometry/PointOrders.h"

#include "Geometry/NearestNodes.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <queue>
#include <utility>

namespace morph
{
namespace
{
constexpr Index BetweenChecks = 1024;

/// A point's distance from the nearest chosen one. Later entries of a point supersede earlier ones.
struct Candidate
{
  double distance;
  Index point;
  bool operator<(const Candidate& other) const
  {
    return this->distance != other.distance ? this->distance < other.distance
                                            : this->point > other.point;
  }
};

/// Distances that differ by less than this part are a tie, which rounding must not decide. It is
/// above what single precision does to sites that are 1 % of the extent apart.
constexpr double Tie = 1e-5;
/// Coordinates that differ by less than this part of the extent are equal.
constexpr double SameCoordinate = 1e-6;

/// Sorts ids by x, those of equal x by y, and those of equal y by z. Each of a run of coordinates
/// is equal to the next. So neither rounding nor the order of the points decides.
void sortByPlace(const Points& points, double same, std::vector<Index>::iterator first,
  std::vector<Index>::iterator last, int axis = 0)
{
  std::sort(first, last,
    [&](Index a, Index b)
    {
      const double x = points(a, axis), y = points(b, axis);
      return x != y ? x < y : a < b;
    });
  for (auto begin = first; axis < 2 && begin != last;)
  {
    auto end = begin + 1;
    while (end != last && points(*end, axis) - points(*(end - 1), axis) <= same)
    {
      ++end;
    }
    if (end - begin > 1)
    {
      sortByPlace(points, same, begin, end, axis + 1);
    }
    begin = end;
  }
}

/// The first, by place, of the points with the largest measure.
template <typename Measure>
Index farthest(const Points& points, double same, const Measure& measure)
{
  double most = 0;
  for (Index i = 0; i < points.rows(); ++i)
  {
    most = std::max(most, measure(points.row(i)));
  }
  std::vector<Index> ties;
  for (Index i = 0; i < points.rows(); ++i)
  {
    if (measure(points.row(i)) >= (1 - Tie) * most)
    {
      ties.push_back(i);
    }
  }
  sortByPlace(points, same, ties.begin(), ties.end());
  return ties.front();
}

/// The corners of a large simplex, as far as the points have so many dimensions.
std::vector<Index> simplex(const Points& points, double same)
{
  using Row = Eigen::RowVector3d;
  const Row mean = points.colwise().mean();
  std::vector<Index> corners = { farthest(
    points, same, [&](const Row& x) { return (x - mean).squaredNorm(); }) };
  const Row origin = points.row(corners[0]);
  const auto add = [&](Index corner)
  {
    if (std::find(corners.begin(), corners.end(), corner) == corners.end())
    {
      corners.push_back(corner);
    }
  };
  add(farthest(points, same, [&](const Row& x) { return (x - origin).squaredNorm(); }));
  const Row along = points.row(corners.back()) - origin;
  add(farthest(points, same, [&](const Row& x) { return along.cross(x - origin).squaredNorm(); }));
  const Row normal = along.cross(points.row(corners.back()) - origin);
  add(farthest(points, same, [&](const Row& x) { return std::abs(normal.dot(x - origin)); }));
  return corners;
}
}

FarthestPoints farthestPoints(const Points& points, Monitor& monitor)
{
  FarthestPoints result;
  const Index n = points.rows();
  if (n == 0)
  {
    return result;
  }
  const NearestNodes nodes(points);
  const double same =
    SameCoordinate * (points.colwise().maxCoeff() - points.colwise().minCoeff()).maxCoeff();
  std::vector<double> distance(n, std::numeric_limits<double>::infinity());
  std::priority_queue<Candidate> candidates;
  std::vector<std::int32_t> near;
  // `most`: no point is farther than that from those before; only nearer ones change.
  const auto choose = [&](Index chosen, double most)
  {
    result.order.push_back(chosen);
    const bool isCorner = result.order.size() <= 4;
    // Of a tie a later one may be farther than one before; the first after the corners may be
    // farther than the last of them.
    result.distances.push_back(result.order.size() <= 5
                                 ? distance[chosen]
                                 : std::min(distance[chosen], result.distances.back()));
    distance[chosen] = -1;
    const auto update = [&](Index i)
    {
      const double d = (points.row(i) - points.row(chosen)).norm();
      if (d < distance[i])
      {
        distance[i] = d;
        candidates.push({ d, i });
      }
    };
    if (isCorner)
    {
      for (Index i = 0; i < n; ++i)
      {
        update(i);
      }
      return;
    }
    nodes.within(points.row(chosen), most, near);
    for (std::int32_t i : near)
    {
      update(i);
    }
  };
  for (Index corner : simplex(points, same))
  {
    choose(corner, std::numeric_limits<double>::infinity());
  }
  std::vector<Index> ties;
  while (static_cast<Index>(result.order.size()) < n)
  {
    ties.clear();
    double most = 0;
    while (!candidates.empty())
    {
      const Candidate best = candidates.top();
      if (best.distance == distance[best.point])
      {
        if (!ties.empty() && best.distance < (1 - Tie) * most)
        {
          break;
        }
        most = std::max(most, best.distance);
        ties.push_back(best.point);
      }
      candidates.pop();
    }
    sortByPlace(points, same, ties.begin(), ties.end());
    for (const Index point : ties)
    {
      // One that a point before has made nearer is a candidate again.
      if (distance[point] >= (1 - Tie) * most)
      {
        choose(point, most);
        if (result.order.size() % BetweenChecks == 0)
        {
          monitor.check();
        }
      }
    }
  }
  return result;
}

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
