// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/RadialBasis.h"

#include "Geometry/AffineFit.h"
#include "Geometry/PointOrders.h"
#include "Support/Error.h"
#include "Support/Monitor.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace morph
{
namespace
{
constexpr double NearestCenters = 1e-5; // of the extent
}

void RadialBasis::setSupportRadius(double radius)
{
  if (!(radius > 0 && std::isfinite(radius)))
  {
    std::ostringstream text;
    text << "The support radius must be a positive number; it is " << radius << ".";
    throw Error(text.str());
  }
  this->supportRadius_ = radius;
}

void RadialBasis::setNumberOfCenters(Index count)
{
  if (count != 0 && (count < FewestCenters || count > MostCenters))
  {
    throw Error("The number of centers must be 0 or " + std::to_string(FewestCenters) + " to " +
                std::to_string(MostCenters) + "; it is " + std::to_string(count) + ".");
  }
  this->numberOfCenters_ = count;
}

void RadialBasis::requireSpace() const
{
  const int rank = AffineLeastSquares(this->sites_.coordinates()).directions().rank();
  if (rank < 3)
  {
    const char* where[] = { "coincide", "lie on one line", "lie in one plane" };
    throw Error(Error::Kind::Singular,
      "The " + std::to_string(this->sites_.size()) + " distinct places of prescribed nodes " +
        where[rank] +
        ", so they do not determine the linear part of the motion. Prescribe nodes off the plane, "
        "for instance the whole boundary.");
  }
}

Points RadialBasis::scaled(const Points& positions) const
{
  return (positions.rowwise() - this->origin_) / this->extent_;
}

void RadialBasis::doPrepare(const Mesh& rest, Monitor& monitor)
{
  this->sites_ = InterpolationSites(rest.points, this->partition().prescribed);
  this->requireSpace();
  const Points& sites = this->sites_.coordinates();
  // Differences first: the mean of sites far from the origin would be inexact.
  this->origin_ = sites.row(0);
  this->origin_ += (sites.rowwise() - this->origin_).colwise().mean();
  this->extent_ = 2 * (sites.rowwise() - this->origin_).rowwise().norm().maxCoeff();
  const Points places = this->scaled(sites);
  this->freePlaces_ = this->scaled(rest.points(this->partition().free, allColumns));

  const FarthestPoints far = farthestPoints(places, monitor);
  const Index n = places.rows();
  const Index most = this->numberOfCenters_ > 0 ? this->numberOfCenters_
                     : n <= MostCenters         ? n
                                                : CentersOfMany;
  Index centers = std::min(n, FewestCenters);
  while (centers < std::min(n, most) && far.distances[centers] > NearestCenters)
  {
    ++centers;
  }
  const Points ordered = places(far.order, allColumns);
  this->order_ = far.order;
  this->otherPlaces_ = ordered.bottomRows(n - centers);
  monitor.progress(0.1);

  ProgressRange factorizing(monitor, 0.1, 0.8);
  if (!this->interpolant_.prepare(
        { this->kind_, this->supportRadius_ }, ordered.topRows(centers), factorizing))
  {
    std::ostringstream text;
    text << "The system of " << centers << " radial basis functions is singular to rounding; "
         << "its nearest centers are " << far.distances[centers - 1] * this->extent_
         << " apart. Choose fewer centers, or a smaller support radius.";
    throw Error(Error::Kind::Singular, text.str());
  }
  ProgressRange correcting(monitor, 0.8, 1);
  this->correction_.prepare(ordered, far.distances, centers, this->freePlaces_, correcting);
  this->largestResidual_ = 0;
}

EvaluateReport RadialBasis::report(double residual) const
{
  EvaluateReport report;
  // Counts are whole numbers; rounded up, so that 0 means none.
  const double millionths = std::min(std::ceil(1e6 * residual / this->extent_), 1e18);
  report.statistics = { { "Centers", this->centers() },
    { "CorrectedSites", this->correctedSites() },
    { "LargestResidualPPM", millionths > 0 ? static_cast<Index>(millionths) : 0 } };
  return report;
}

EvaluateReport RadialBasis::displace(const Points& prescribed, Points& free, Monitor& monitor) const
{
  const Points values = this->sites_.average(prescribed, monitor)(this->order_, allColumns);
  monitor.check();
  const auto coefficients = this->interpolant_.solve(values.topRows(this->centers()));
  Points residuals = Points::Zero(values.rows(), 3), atOthers;
  this->interpolant_.evaluate(coefficients, this->otherPlaces_, atOthers, monitor);
  residuals.bottomRows(this->correctedSites()) =
    values.bottomRows(this->correctedSites()) - atOthers;
  const double largest = residuals.rowwise().norm().maxCoeff();
  this->largestResidual_ = largest;
  this->interpolant_.evaluate(coefficients, this->freePlaces_, free, monitor);
  this->correction_.addTo(free, std::move(residuals), monitor);
  return this->report(largest);
}

EvaluateReport RadialBasis::displaceTranspose(
  const Points& free, Points& prescribed, Monitor& monitor) const
{
  monitor.check();
  auto gradient = this->interpolant_.evaluateTranspose(this->freePlaces_, free, monitor);
  Points ordered = this->correction_.transposed(free, monitor);
  const Points ofResiduals = ordered.bottomRows(this->correctedSites());
  const auto ofOthers =
    this->interpolant_.evaluateTranspose(this->otherPlaces_, ofResiduals, monitor);
  gradient.ofKernels -= ofOthers.ofKernels;
  gradient.ofPolynomial -= ofOthers.ofPolynomial;
  ordered.topRows(this->centers()) = this->interpolant_.solveTranspose(gradient);
  Points result(this->sites_.size(), 3);
  result(this->order_, allColumns) = ordered;
  this->sites_.scatterTranspose(result, prescribed);
  return this->report(0);
}

std::vector<Index> RadialBasis::centerNodes() const
{
  std::vector<Index> nodes;
  for (Index i = 0; i < this->centers(); ++i)
  {
    const Index first = *this->sites_.prescribed().begin(this->order_[i]);
    nodes.push_back(this->partition().prescribed[first]);
  }
  return nodes;
}
}
