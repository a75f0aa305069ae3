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

template <typename Measure>
Index farthest(const Points& points, const Measure& measure)
{
  Index best = 0;
  double most = -1;
  for (Index i = 0; i < points.rows(); ++i)
  {
    const double value = measure(points.row(i));
    if (value > most)
    {
      most = value;
      best = i;
    }
  }
  return best;
}

/// The corners of a large simplex, as far as the points have so many dimensions.
std::vector<Index> simplex(const Points& points)
{
  using Row = Eigen::RowVector3d;
  const Row mean = points.colwise().mean();
  std::vector<Index> corners = { farthest(
    points, [&](const Row& x) { return (x - mean).squaredNorm(); }) };
  const Row origin = points.row(corners[0]);
  const auto add = [&](Index corner)
  {
    if (std::find(corners.begin(), corners.end(), corner) == corners.end())
    {
      corners.push_back(corner);
    }
  };
  add(farthest(points, [&](const Row& x) { return (x - origin).squaredNorm(); }));
  const Row along = points.row(corners.back()) - origin;
  add(farthest(points, [&](const Row& x) { return along.cross(x - origin).squaredNorm(); }));
  const Row normal = along.cross(points.row(corners.back()) - origin);
  add(farthest(points, [&](const Row& x) { return std::abs(normal.dot(x - origin)); }));
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
  std::vector<double> distance(n, std::numeric_limits<double>::infinity());
  std::priority_queue<Candidate> candidates;
  std::vector<std::int32_t> near;
  const auto choose = [&](Index chosen)
  {
    const double own = distance[chosen];
    result.order.push_back(chosen);
    result.distances.push_back(own);
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
    if (static_cast<Index>(result.order.size()) <= 4)
    {
      for (Index i = 0; i < n; ++i)
      {
        update(i);
      }
      return;
    }
    // No point is farther than `own` from those before; only nearer ones change.
    nodes.within(points.row(chosen), own, near);
    for (std::int32_t i : near)
    {
      update(i);
    }
  };
  for (Index corner : simplex(points))
  {
    choose(corner);
  }
  while (static_cast<Index>(result.order.size()) < n)
  {
    const Candidate best = candidates.top();
    candidates.pop();
    if (best.distance == distance[best.point])
    {
      choose(best.point);
      if (result.order.size() % BetweenChecks == 0)
      {
        monitor.check();
      }
    }
  }
  return result;
}
}
