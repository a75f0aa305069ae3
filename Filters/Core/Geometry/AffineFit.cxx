// SPDX-License-Identifier: BSD-3-Clause
#include "Geometry/AffineFit.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace morph
{
namespace
{
Eigen::RowVector3d sumOfRows(const Points& points)
{
  Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
  for (Index i = 0; i < points.rows(); ++i)
  {
    sum += points.row(i);
  }
  return sum;
}

Eigen::RowVector3d meanOfRows(const Points& points)
{
  return sumOfRows(points) / static_cast<double>(std::max<Index>(points.rows(), 1));
}

/// The leverage beyond that of the points up to which a direction counts whole.
constexpr double MostLeverage = 8;
/// Places count as at least so far from the points' plane or line, of the largest extent: what is
/// less uneven is rounding.
constexpr double LeastReach = 1e-5;
constexpr double Flat = 1e-7;     // of the largest extent: the rounding of sums of squares
constexpr double Extended = 1e-5; // of the largest extent
}

PrincipalDirections::PrincipalDirections(const Eigen::Matrix3d& spread, double count)
  : count_(count)
{
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread);
  this->axes_ = solver.eigenvectors();
  this->extent_ = (solver.eigenvalues() / std::max(count, 1.)).cwiseMax(0).cwiseSqrt().transpose();
  this->limit(Eigen::RowVector3d::Ones(), Eigen::RowVector3d::Ones());
}

void PrincipalDirections::measure(const Points& arms)
{
  Eigen::RowVector3d squares = Eigen::RowVector3d::Zero();
  for (Index i = 0; i < arms.rows(); ++i)
  {
    squares += (arms.row(i) * this->axes_).cwiseAbs2();
  }
  this->extent_ = (squares / std::max(this->count_, 1.)).cwiseSqrt();
}

Eigen::RowVector3d PrincipalDirections::leverages(const Eigen::RowVector3d& arm) const
{
  const Eigen::RowVector3d x = arm * this->axes_;
  Eigen::RowVector3d result;
  for (int j = 0; j < 3; ++j)
  {
    const double extent = std::max(this->extent_[j], Flat * this->extent_[2]);
    double sum = 0;
    for (int k = 0; k < 3; ++k)
    {
      // Of flat points even 0 / 0.
      const double other = this->extent_[k];
      const double term = other < extent ? x[k] * (other / extent) / extent : x[k] / other;
      sum += other > 0 ? term * term : 0;
    }
    result[j] = std::sqrt(sum);
  }
  return result;
}

void PrincipalDirections::limit(const Eigen::RowVector3d& within, const Eigen::RowVector3d& reach)
{
  for (int j = 0; j < 3; ++j)
  {
    this->shares_[j] = 0;
    if (this->extent_[j] > Flat * this->extent_[2])
    {
      const double least = LeastReach * this->extent_[2] / this->extent_[j];
      const double beyond = std::max(reach[j], least) - within[j];
      const double part = MostLeverage / std::max(beyond, MostLeverage);
      this->shares_[j] = part * part;
    }
  }
}

int PrincipalDirections::rank() const
{
  return static_cast<int>((this->extent_.array() > Extended * this->extent_[2]).count());
}

Eigen::Matrix3d PrincipalDirections::inverse() const
{
  Eigen::Vector3d inverse = Eigen::Vector3d::Zero();
  for (int j = 0; j < 3; ++j)
  {
    if (this->shares_[j] > 0)
    {
      inverse[j] = this->shares_[j] / (this->count_ * this->extent_[j] * this->extent_[j]);
    }
  }
  return this->axes_ * inverse.asDiagonal() * this->axes_.transpose();
}

Eigen::Matrix3d PrincipalDirections::rest() const
{
  const Eigen::Vector3d rest = (1 - this->shares_.array()).matrix().transpose();
  return this->axes_ * rest.asDiagonal() * this->axes_.transpose();
}

AffineLeastSquares::AffineLeastSquares(const Points& rest, const ConstPoints& places)
{
  // Sum differences: sums of coordinates far from the origin would lose the digits that tell the
  // points apart.
  Eigen::RowVector3d first = Eigen::RowVector3d::Zero();
  if (rest.rows() > 0)
  {
    first = rest.row(0);
  }
  this->arms_ = rest.rowwise() - first;
  const Eigen::RowVector3d middle = meanOfRows(this->arms_);
  this->center_ = first + middle;
  this->arms_.rowwise() -= middle;
  Eigen::Matrix3d Q = Eigen::Matrix3d::Zero();
  for (Index i = 0; i < rest.rows(); ++i)
  {
    Q.noalias() += this->arms_.row(i).transpose() * this->arms_.row(i);
  }
  this->directions_ = PrincipalDirections(Q, static_cast<double>(rest.rows()));
  this->directions_.measure(this->arms_);
  const auto largest = [&](const ConstPoints& of)
  {
    Eigen::RowVector3d leverages = Eigen::RowVector3d::Zero();
    for (Index i = 0; i < of.rows(); ++i)
    {
      leverages = leverages.cwiseMax(this->directions_.leverages(of.row(i) - this->center_));
    }
    return leverages;
  };
  this->directions_.limit(largest(rest), largest(places));
  this->inverse_ = this->directions_.inverse();
}

AffineFit AffineLeastSquares::fit(const Points& displacement) const
{
  const Eigen::RowVector3d mean = meanOfRows(displacement);
  Eigen::Matrix3d P = Eigen::Matrix3d::Zero();
  for (Index i = 0; i < displacement.rows(); ++i)
  {
    P.noalias() += this->arms_.row(i).transpose() * (displacement.row(i) - mean);
  }
  return { this->center_, mean, this->inverse_, P };
}

Eigen::VectorXd AffineLeastSquares::weights(const Eigen::RowVector3d& place) const
{
  const Eigen::Vector3d slope = this->inverse_ * (place - this->center_).transpose();
  return (this->arms_ * slope).array() + 1 / static_cast<double>(this->arms_.rows());
}

void AffineLeastSquares::fitTranspose(
  const Points& x, const Points& gradient, Points& displacement) const
{
  const Eigen::RowVector3d ofMean = sumOfRows(gradient) / static_cast<double>(displacement.rows());
  Eigen::Matrix3d ofGradient = Eigen::Matrix3d::Zero();
  for (Index i = 0; i < x.rows(); ++i)
  {
    ofGradient.noalias() += (x.row(i) - this->center_).transpose() * gradient.row(i);
  }
  // The arms sum to zero, so the mean within P adds no term.
  const Eigen::Matrix3d ofP = this->inverse_ * ofGradient;
  for (Index i = 0; i < displacement.rows(); ++i)
  {
    displacement.row(i) += ofMean + this->arms_.row(i) * ofP;
  }
}
}
