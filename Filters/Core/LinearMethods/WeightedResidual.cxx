// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/WeightedResidual.h"

#include "Interpolation/InverseDistanceWeights.h"
#include "Support/Error.h"
#include "Support/Parallel.h"

#include <Eigen/LU>

#include <sstream>

namespace morph
{
namespace
{
constexpr Index Grain = 1024;
}

void WeightedResidual::setNumberOfNeighbors(Index count)
{
  if (count < 1)
  {
    throw Error("The number of neighbors must be at least 1; it is " + std::to_string(count) + ".");
  }
  this->numberOfNeighbors_ = count;
}

void WeightedResidual::doPrepare(const Mesh& rest, Monitor& monitor)
{
  this->sites_ = InterpolationSites(rest.points, this->partition().prescribed);
  this->freePlaces_ = rest.points(this->partition().free, allColumns);
  this->fit_ = AffineLeastSquares(this->sites_.coordinates(), this->freePlaces_);
  monitor.check();

  this->weights_ =
    inverseDistanceWeights(this->sites_, this->freePlaces_, this->numberOfNeighbors_, monitor);
}

void WeightedResidual::warnOf(const Points& prescribed, Monitor& monitor) const
{
  const AffineFit fit = this->fit_.fit(this->sites_.average(prescribed, monitor));
  const double determinant = (Eigen::Matrix3d::Identity() + fit.gradient()).determinant();
  if (!(determinant > 0))
  {
    std::ostringstream text;
    text << "The affine map fitted to the boundary's motion has determinant " << determinant
         << ": it reflects or flattens the mesh. Move the boundary in smaller steps, or use a "
            "method that follows "
            "the mesh's cells.";
    monitor.warn(text.str());
  }
}

EvaluateReport WeightedResidual::displace(
  const Points& prescribed, Points& free, Monitor& monitor) const
{
  Points residual = this->sites_.average(prescribed, monitor);
  const AffineFit fit = this->fit_.fit(residual);
  for (Index s = 0; s < residual.rows(); ++s)
  {
    residual.row(s) -= fit.displacement(this->sites_.coordinates().row(s));
  }
  monitor.check();
  this->weights_.multiply(residual, free, monitor);
  parallel(free.rows(), Grain, monitor,
    [&](Index i) { free.row(i) += fit.displacement(this->freePlaces_.row(i)); });
  return {};
}

EvaluateReport WeightedResidual::displaceTranspose(
  const Points& free, Points& prescribed, Monitor& monitor) const
{
  // u = L_x U + W (U - L_b U), hence the adjoint W^T g + L_x^T g - L_b^T W^T g.
  Points onSites;
  monitor.check();
  this->weights_.multiplyTranspose(free, onSites, monitor);
  Points result = onSites;
  this->fit_.fitTranspose(this->freePlaces_, free, result);
  this->fit_.fitTranspose(this->sites_.coordinates(), -onSites, result);
  this->sites_.scatterTranspose(result, prescribed);
  return {};
}
}
