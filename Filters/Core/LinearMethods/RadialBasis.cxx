// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/RadialBasis.h"

#include "Geometry/AffineFit.h"
#include "Geometry/FarthestPoints.h"
#include "Support/Error.h"
#include "Support/ProgressRange.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace morph
{
namespace
{
constexpr double NearestCentres = 1e-5; // of the extent
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

void RadialBasis::setNumberOfCentres(Index count)
{
  if (count != 0 && (count < FewestCentres || count > MostCentres))
  {
    throw Error("The number of centres must be 0 or " + std::to_string(FewestCentres) + " to " +
                std::to_string(MostCentres) + "; it is " + std::to_string(count) + ".");
  }
  this->numberOfCentres_ = count;
}

void RadialBasis::requireSpace() const
{
  const int rank = AffineLeastSquares(this->sites_.coordinates()).rank();
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
  const Index most = this->numberOfCentres_ > 0 ? this->numberOfCentres_
                     : n <= MostCentres         ? n
                                                : CentresOfMany;
  Index centres = std::min(n, FewestCentres);
  while (centres < std::min(n, most) && far.distances[centres] > NearestCentres)
  {
    ++centres;
  }
  this->centreSites_.assign(far.order.begin(), far.order.begin() + centres);
  this->otherSites_.assign(far.order.begin() + centres, far.order.end());
  this->otherPlaces_ = places(this->otherSites_, allColumns);
  monitor.progress(0.1);

  ProgressRange factorizing(monitor, 0.1, 0.8);
  if (!this->interpolant_.prepare(
        { this->kind_, this->supportRadius_ }, places(this->centreSites_, allColumns), factorizing))
  {
    std::ostringstream text;
    text << "The system of " << centres << " radial basis functions is singular to rounding; "
         << "its nearest centres are " << far.distances[centres - 1] * this->extent_
         << " apart. Choose fewer centres, or a smaller support radius.";
    throw Error(Error::Kind::Singular, text.str());
  }
  ProgressRange correcting(monitor, 0.8, 1);
  this->correction_.prepare(this->otherPlaces_,
    { far.distances.begin() + centres, far.distances.end() }, this->freePlaces_, correcting);
  this->largestResidual_ = 0;
}

EvaluateReport RadialBasis::report(double residual) const
{
  EvaluateReport report;
  report.bytesMoved = static_cast<double>(this->memory()) +
                      sizeof(double) * static_cast<double>(this->freePlaces_.size());
  // Counts are whole numbers; rounded up, so that 0 means none.
  const double millionths = std::min(std::ceil(1e6 * residual / this->extent_), 1e18);
  report.statistics = { { "Centers", this->centres() },
    { "CorrectedSites", this->correctedSites() },
    { "LargestResidualPPM", millionths > 0 ? static_cast<Index>(millionths) : 0 } };
  return report;
}

EvaluateReport RadialBasis::displace(const Points& prescribed, Points& free, Monitor& monitor) const
{
  const Points values = this->sites_.average(prescribed);
  monitor.check();
  const auto coefficients = this->interpolant_.solve(values(this->centreSites_, allColumns));
  Points residuals;
  this->interpolant_.evaluate(coefficients, this->otherPlaces_, residuals, monitor);
  residuals = values(this->otherSites_, allColumns) - residuals;
  const double largest = residuals.rows() > 0 ? residuals.rowwise().norm().maxCoeff() : 0;
  this->largestResidual_ = largest;
  this->correction_.solve(residuals);

  this->interpolant_.evaluate(coefficients, this->freePlaces_, free, monitor);
  if (residuals.rows() > 0)
  {
    Points correction;
    this->correction_.atTargets().multiply(residuals, correction, monitor);
    free += correction;
  }
  return this->report(largest);
}

EvaluateReport RadialBasis::displaceTranspose(
  const Points& free, Points& prescribed, Monitor& monitor) const
{
  monitor.check();
  auto gradient = this->interpolant_.evaluateTranspose(this->freePlaces_, free, monitor);
  Points result = Points::Zero(this->sites_.size(), 3);
  if (this->correctedSites() > 0)
  {
    Points residuals;
    this->correction_.atTargets().multiplyTranspose(free, residuals, monitor);
    this->correction_.solveTranspose(residuals);
    result(this->otherSites_, allColumns) = residuals;
    const auto ofResiduals =
      this->interpolant_.evaluateTranspose(this->otherPlaces_, residuals, monitor);
    gradient.ofKernels -= ofResiduals.ofKernels;
    gradient.ofPolynomial -= ofResiduals.ofPolynomial;
  }
  result(this->centreSites_, allColumns) = this->interpolant_.solveTranspose(gradient);
  this->sites_.scatterTranspose(result, prescribed);
  return this->report(0);
}

std::vector<Index> RadialBasis::centreNodes() const
{
  std::vector<Index> nodes;
  for (const Index site : this->centreSites_)
  {
    nodes.push_back(this->partition().prescribed[*this->sites_.prescribed().begin(site)]);
  }
  return nodes;
}

std::size_t RadialBasis::memory() const
{
  return this->sites_.memory() + this->interpolant_.memory() + this->correction_.memory() +
         sizeof(double) * (this->otherPlaces_.size() + this->freePlaces_.size()) +
         sizeof(Index) * (this->centreSites_.size() + this->otherSites_.size());
}
}
