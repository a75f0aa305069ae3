// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMorphing/HandleMotion.h"

#include "Mesh/Mesh.h"
#include "Support/Error.h"
#include "Support/Parallel.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

namespace morph
{
namespace
{
constexpr double SamePlace = 1e-10; // of the handles' extent
constexpr double LargestResidual = 1e-9;

void require(const std::vector<Handle>& handles, bool areSmoothed)
{
  if (handles.empty())
  {
    throw Error("There is no handle: give at least one.");
  }
  const Index most = areSmoothed ? HandleMotion::MostSmoothed : HandleMotion::MostHandles;
  if (static_cast<Index>(handles.size()) > most)
  {
    throw Error("There are " + std::to_string(handles.size()) + " handles, and at most " +
                std::to_string(most) + " are possible" +
                (areSmoothed ? "."
                             : "; with `HandleSmoothing`, which approximates them, " +
                                 std::to_string(HandleMotion::MostSmoothed) + "."));
  }
  std::vector<Index> bad;
  for (std::size_t i = 0; i < handles.size(); ++i)
  {
    const Handle& handle = handles[i];
    if (!isModerate(handle.place) || !isModerate(handle.displacement) ||
        !(handle.radius >= 0 && handle.radius <= LargestLength))
    {
      bad.push_back(static_cast<Index>(i));
    }
  }
  if (!bad.empty())
  {
    throw Error("`Handles` have a number that is not finite or beyond 1e50, or a negative radius: "
                "handles " +
                listIds(bad) + ", counted from 0.");
  }
}

/// Throws Error for two rows that are nearer than `distance`.
void requireApart(const Points& places, double distance)
{
  for (Index i = 0; i < places.rows(); ++i)
  {
    for (Index j = 0; j < i; ++j)
    {
      if ((places.row(i) - places.row(j)).norm() <= distance)
      {
        throw Error("`Handles` " + std::to_string(j) + " and " + std::to_string(i) +
                    ", counted from 0, are in the same place. Remove one of them.");
      }
    }
  }
}

/// The handles' principal directions. What they move is as far from them as they are from one
/// another.
PrincipalDirections directionsOf(const Points& points)
{
  const Points arms = points.rowwise() - points.colwise().mean();
  PrincipalDirections directions(
    arms.transpose() * arms, static_cast<double>(std::max<Index>(points.rows(), 1)));
  Eigen::RowVector3d within = Eigen::RowVector3d::Zero(), reach = within;
  for (Index i = 0; i < arms.rows(); ++i)
  {
    within = within.cwiseMax(directions.leverages(arms.row(i)));
  }
  const double size = arms.rowwise().norm().maxCoeff();
  for (int j = 0; j < 3; ++j)
  {
    reach = reach.cwiseMax(directions.leverages(size * directions.axes().col(j).transpose()));
  }
  directions.limit(within, reach);
  return directions;
}

/// The solution of the symmetric `matrix` for the values `given`. Throws Error where rounding or
/// overlapping radii leave none. `largest`: of the displacements.
Eigen::MatrixXd solve(const Eigen::MatrixXd& matrix, const Points& values, double largest)
{
  Eigen::MatrixXd given = Eigen::MatrixXd::Zero(matrix.rows(), 3);
  given.topRows(values.rows()) = values;
  const Eigen::PartialPivLU<Eigen::MatrixXd> factor(matrix);
  Eigen::MatrixXd solution = factor.solve(given);
  solution += factor.solve(given - matrix * solution); // one step of refinement
  const double residual = (given - matrix * solution).cwiseAbs().maxCoeff();
  if (!solution.allFinite() || !(residual <= LargestResidual * largest))
  {
    throw Error(Error::Kind::Singular,
      "No smooth motion takes the displacements of these handles: they are too near each other for "
      "their radii. Remove some, or give those that overlap the same radius.");
  }
  return solution;
}

Points rows(const Points& of, const std::vector<Index>& ids)
{
  return of(ids, allColumns);
}
}

HandleMotion::HandleMotion(const std::vector<Handle>& handles, double smoothing)
{
  require(handles, smoothing > 0);
  const auto n = static_cast<Index>(handles.size());
  Points places(n, 3), values(n, 3);
  for (Index i = 0; i < n; ++i)
  {
    places.row(i) = handles[i].place;
    values.row(i) = handles[i].displacement;
  }
  if (smoothing == 0)
  {
    this->interpolate(handles, places, values);
    return;
  }
  if (std::any_of(handles.begin(), handles.end(), [](const Handle& one) { return one.radius > 0; }))
  {
    throw Error(
      "`HandleSmoothing` approximates handles that have no radius, and some have one. Set "
      "their radius to 0, or the smoothing.");
  }
  this->smooth(places, values, smoothing);
}

void HandleMotion::smooth(const Points& places, Points values, double length)
{
  this->trend_ = AffineLeastSquares(places).fit(values);
  for (Index i = 0; i < places.rows(); ++i)
  {
    values.row(i) -= this->trend_.displacement(places.row(i));
  }
  this->length_ = length;
  this->places_ = places;
  this->residuals_ = std::move(values);
  this->handles_ = std::make_unique<NearestNodes>(places);
}

Eigen::RowVector3d HandleMotion::residual(const Eigen::RowVector3d& place) const
{
  RadialKernel kernel;
  kernel.kind = RadialKernel::Kind::WendlandC2;
  kernel.radius = this->length_ + this->handles_->distance(place);
  std::vector<std::int32_t> near;
  this->handles_->within(place, kernel.radius, near);
  Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
  double weights = 0;
  for (const std::int32_t i : near)
  {
    const double weight = kernel((place - this->places_.row(i)).squaredNorm());
    sum += weight * this->residuals_.row(i);
    weights += weight;
  }
  return weights > 0 ? Eigen::RowVector3d(sum / weights) : sum;
}

void HandleMotion::interpolate(
  const std::vector<Handle>& handles, const Points& given, Points values)
{
  const Index n = given.rows();
  Points places = given;
  double widest = 0;
  std::map<double, std::vector<Index>> ofRadius; // 0 comes first
  for (Index i = 0; i < n; ++i)
  {
    widest = std::max(widest, handles[i].radius);
    ofRadius[handles[i].radius].push_back(i);
  }
  const double largest = values.cwiseAbs().maxCoeff();
  const Eigen::RowVector3d low = places.colwise().minCoeff(), high = places.colwise().maxCoeff();
  const double extent = (high - low).norm();
  requireApart(places, SamePlace * extent);
  this->center_ = 0.5 * (low + high);
  this->size_ = std::max(extent, widest) > 0 ? std::max(extent, widest) : 1;

  const std::vector<Index> unlimited = ofRadius.count(0) ? ofRadius.at(0) : std::vector<Index>();
  this->hasPolynomial_ = !unlimited.empty();
  PrincipalDirections directions(Eigen::Matrix3d::Zero(), 0);
  if (this->hasPolynomial_)
  {
    const Points free = rows(places, unlimited);
    directions = directionsOf(free);
    const Eigen::RowVector3d mean = free.colwise().mean(),
                             of = rows(values, unlimited).colwise().mean();
    this->trend_ = AffineFit(mean, of, directions.inverse(),
      (free.rowwise() - mean).transpose() * (rows(values, unlimited).rowwise() - of));
    for (Index i = 0; i < n; ++i)
    {
      values.row(i) -= this->trend_.displacement(places.row(i));
    }
  }
  places = (places.rowwise() - this->center_) / this->size_;

  const Index terms = this->hasPolynomial_ ? 4 : 0;
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n + terms, n + terms);
  for (const auto& [radius, ids] : ofRadius)
  {
    RadialKernel kernel;
    kernel.kind = radius == 0 ? RadialKernel::Kind::ThinPlate : RadialKernel::Kind::WendlandC2;
    kernel.radius = radius == 0 ? 1 : radius / this->size_;
    for (const Index j : ids)
    {
      for (Index i = 0; i < n; ++i)
      {
        matrix(i, j) = kernel((places.row(i) - places.row(j)).squaredNorm());
      }
    }
    this->groups_.push_back({ kernel, rows(places, ids), Points() });
  }
  if (terms > 0)
  {
    matrix.col(n).head(n).setOnes();
    matrix.block(0, n + 1, n, 3) = places * directions.axes().rowwise().reverse();
    for (const Index j : unlimited)
    {
      matrix.col(j).tail(terms) = matrix.row(j).tail(terms).transpose();
    }
  }

  // The polynomial varies along the directions that count. Where one counts in part, so do the
  // answers with and without it, which both take the handles' displacements.
  Eigen::MatrixXd solution = Eigen::MatrixXd::Zero(n + terms, 3);
  double left = 1;
  for (Index rank = terms > 0 ? 3 : 0; rank >= 0 && left > 0; --rank)
  {
    const double share = rank == 0 ? left : left * directions.shares()[3 - rank];
    const Index size = terms > 0 ? n + 1 + rank : n;
    if (share > 0)
    {
      solution.topRows(size) += share * solve(matrix.topLeftCorner(size, size), values, largest);
    }
    left -= share;
  }
  auto group = this->groups_.begin();
  for (const auto& [radius, ids] : ofRadius)
  {
    group->strengths = solution(ids, allColumns);
    ++group;
  }
  if (terms > 0)
  {
    this->polynomial_.row(0) = solution.row(n);
    this->polynomial_.bottomRows<3>() =
      directions.axes().rowwise().reverse() * solution.bottomRows(3);
  }
}

Points HandleMotion::displacements(const Points& places, Monitor& monitor) const
{
  Points result = Points::Zero(places.rows(), 3), sums;
  if (this->handles_)
  {
    constexpr Index Grain = 64;
    parallel(places.rows(), Grain, monitor,
      [&](Index i) {
        result.row(i) = this->trend_.displacement(places.row(i)) + this->residual(places.row(i));
      });
    return result;
  }
  const Points scaled = (places.rowwise() - this->center_) / this->size_;
  for (const Group& group : this->groups_)
  {
    kernelSums(group.kernel, scaled, group.centers, group.strengths, sums, monitor);
    result += sums;
  }
  for (Index i = 0; this->hasPolynomial_ && i < places.rows(); ++i)
  {
    result.row(i) += this->trend_.displacement(places.row(i)) + this->polynomial_.row(0) +
                     scaled.row(i) * this->polynomial_.bottomRows<3>();
  }
  return result;
}
}
