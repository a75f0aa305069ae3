// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMorphing/Falloff.h"

#include "Geometry/NearestNodes.h"
#include "Interpolation/InverseDistanceWeights.h"
#include "Support/Error.h"
#include "Support/Lists.h"
#include "Support/Parallel.h"

#include <cmath>

namespace morph
{
namespace
{
constexpr Index Neighbors = 20;
constexpr Index Grain = 1024;

/// Returns the distance of each place from the nearest node.
std::vector<double> distances(const Points& nodes, const Points& places, Monitor& monitor)
{
  std::vector<double> result(places.rows());
  const NearestNodes nearest(nodes);
  parallel(
    places.rows(), Grain, monitor, [&](Index i) { result[i] = nearest.distance(places.row(i)); });
  return result;
}
}

void Falloff::prepare(const Points& moving, const Points& places, double radius, Monitor& monitor)
{
  if (!(radius > 0) || !std::isfinite(radius))
  {
    throw Error("The radius of the falloff is " + std::to_string(radius) +
                "; it has to be a positive number.");
  }
  if (moving.rows() == 0)
  {
    throw Error("No node moves, so there is nothing that could fade.");
  }
  this->places_ = places.rows();
  this->sites_ = InterpolationSites(moving, consecutive(moving.rows()));
  this->reached_.clear();
  this->factor_.clear();
  const std::vector<double> distance = distances(this->sites_.coordinates(), places, monitor);
  for (Index i = 0; i < places.rows(); ++i)
  {
    const double t = distance[i] / radius;
    if (t < 1)
    {
      const double s = (1 - t) * (1 - t);
      this->reached_.push_back(i);
      this->factor_.push_back(s * s * (4 * t + 1));
    }
  }
  monitor.check();
  this->weights_ =
    inverseDistanceWeights(this->sites_, places(this->reached_, allColumns), Neighbors, monitor);
}

Points Falloff::evaluate(const Points& displacement, Monitor& monitor) const
{
  Points near(static_cast<Index>(this->reached_.size()), 3);
  this->weights_.multiply(this->sites_.average(displacement, monitor), near, monitor);
  Points result = Points::Zero(this->places_, 3);
  for (Index i = 0; i < near.rows(); ++i)
  {
    result.row(this->reached_[i]) = this->factor_[i] * near.row(i);
  }
  return result;
}
}
