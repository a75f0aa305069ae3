// SPDX-License-Identifier: BSD-3-Clause
#include "Interpolation/AffineWeights.h"

#include "Geometry/AffineFit.h"
#include "Geometry/NearestNodes.h"
#include "Support/Parallel.h"

#include <algorithm>

namespace morph
{
namespace
{
constexpr Index Grain = 64;
constexpr Index FirstCount = 32;

/// Sets the weights of `row`, which has its sites, to those of the fit at `x`. `limits`: directions
/// count by their shares. Returns false if the sites lie in a plane.
bool fit(const Points& sites, const Eigen::RowVector3d& x, bool limits, AffineRow& row)
{
  const double count = static_cast<double>(row.sites.size());
  // Relative to the first site: coordinates far from the origin lose no digits.
  const Eigen::RowVector3d first = sites.row(row.sites[0]);
  Eigen::RowVector3d center = Eigen::RowVector3d::Zero();
  for (const std::int32_t site : row.sites)
  {
    center += (sites.row(site) - first) / count;
  }
  center += first;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const std::int32_t site : row.sites)
  {
    const Eigen::RowVector3d arm = sites.row(site) - center;
    spread += arm.transpose() * arm;
  }
  PrincipalDirections directions(spread, count);
  if (limits)
  {
    directions.limit(Eigen::RowVector3d::Ones(), directions.leverages(x - center));
  }
  const Eigen::Vector3d slope = directions.inverse() * (x - center).transpose();
  row.weights.clear();
  for (const std::int32_t site : row.sites)
  {
    row.weights.push_back(1 / count + (sites.row(site) - center).dot(slope));
  }
  return directions.rank() == 3;
}

double largest(const std::vector<double>& weights)
{
  double result = 0;
  for (const double weight : weights)
  {
    result = std::max(result, std::abs(weight));
  }
  return result;
}
}

std::vector<AffineRow> affineWeights(
  const Points& sites, const Points& places, double most, Monitor& monitor)
{
  const NearestNodes nearest(sites);
  std::vector<AffineRow> rows(places.rows());
  parallel(places.rows(), Grain, monitor,
    [&](Index i)
    {
      bool isDone = false;
      for (Index count = FirstCount; !isDone; count *= 2)
      {
        nearest.nearest(places.row(i), count, rows[i].sites);
        const bool spans = fit(sites, places.row(i), false, rows[i]);
        isDone = spans && largest(rows[i].weights) <= most;
        if (!isDone && static_cast<Index>(rows[i].sites.size()) == sites.rows())
        {
          fit(sites, places.row(i), true, rows[i]);
          isDone = true;
        }
      }
    });
  return rows;
}
}
