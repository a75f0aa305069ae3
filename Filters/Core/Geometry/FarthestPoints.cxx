// SPDX-License-Identifier: BSD-3-Clause
#include "Geometry/FarthestPoints.h"

#include "Geometry/NearestNodes.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <limits>
#include <queue>

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
}
