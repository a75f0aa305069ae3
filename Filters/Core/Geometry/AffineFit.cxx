// SPDX-License-Identifier: BSD-3-Clause
#include "Geometry/AffineFit.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>

namespace morph
{
namespace
{
Eigen::RowVector3d sumOfRows(const Points& points, const Communicator& all)
{
  Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
  for (Index i = 0; i < points.rows(); ++i)
  {
    sum += points.row(i);
  }
  all.sum(sum.data(), 3);
  return sum;
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

void PrincipalDirections::measure(const Points& arms, const Communicator& all)
{
  Eigen::RowVector3d squares = Eigen::RowVector3d::Zero();
  for (Index i = 0; i < arms.rows(); ++i)
  {
    squares += (arms.row(i) * this->axes_).cwiseAbs2();
  }
  all.sum(squares.data(), 3);
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

AffineLeastSquares::AffineLeastSquares(
  const Points& rest, const ConstPoints& places, const Communicator& all)
  : count_(all.sum(static_cast<double>(rest.rows())))
{
  // Sum differences: sums of coordinates far from the origin would lose the digits that tell the
  // points apart.
  Eigen::RowVector3d first = Eigen::RowVector3d::Constant(std::numeric_limits<double>::lowest());
  if (rest.rows() > 0)
  {
    first = rest.row(0);
  }
  all.maximum(first.data(), 3);
  if (this->count_ == 0)
  {
    first.setZero();
  }
  this->arms_ = rest.rowwise() - first;
  const Eigen::RowVector3d middle = sumOfRows(this->arms_, all) / std::max(this->count_, 1.);
  this->center_ = first + middle;
  this->arms_.rowwise() -= middle;
  Eigen::Matrix3d Q = Eigen::Matrix3d::Zero();
  for (Index i = 0; i < rest.rows(); ++i)
  {
    Q.noalias() += this->arms_.row(i).transpose() * this->arms_.row(i);
  }
  all.sum(Q.data(), 9);
  this->directions_ = PrincipalDirections(Q, this->count_);
  this->directions_.measure(this->arms_, all);
  const auto largest = [&](const ConstPoints& of)
  {
    Eigen::RowVector3d leverages = Eigen::RowVector3d::Zero();
    for (Index i = 0; i < of.rows(); ++i)
    {
      leverages = leverages.cwiseMax(this->directions_.leverages(of.row(i) - this->center_));
    }
    all.maximum(leverages.data(), 3);
    return leverages;
  };
  this->directions_.limit(largest(rest), largest(places));
  this->inverse_ = this->directions_.inverse();
}

AffineFit AffineLeastSquares::fit(const Points& displacement, const Communicator& all) const
{
  const Eigen::RowVector3d mean = sumOfRows(displacement, all) / std::max(this->count_, 1.);
  Eigen::Matrix3d P = Eigen::Matrix3d::Zero();
  for (Index i = 0; i < displacement.rows(); ++i)
  {
    P.noalias() += this->arms_.row(i).transpose() * (displacement.row(i) - mean);
  }
  all.sum(P.data(), 9);
  return { this->center_, mean, this->inverse_, P };
}

Eigen::VectorXd AffineLeastSquares::weights(const Eigen::RowVector3d& place) const
{
  const Eigen::Vector3d slope = this->inverse_ * (place - this->center_).transpose();
  return (this->arms_ * slope).array() + 1 / static_cast<double>(this->arms_.rows());
}

void AffineLeastSquares::fitTranspose(
  const Points& x, const Points& gradient, Points& displacement, const Communicator& all) const
{
  const Eigen::RowVector3d ofMean = sumOfRows(gradient, all) / this->count_;
  Eigen::Matrix3d ofGradient = Eigen::Matrix3d::Zero();
  for (Index i = 0; i < x.rows(); ++i)
  {
    ofGradient.noalias() += (x.row(i) - this->center_).transpose() * gradient.row(i);
  }
  all.sum(ofGradient.data(), 9);
  // The arms sum to zero, so the mean within P adds no term.
  const Eigen::Matrix3d ofP = this->inverse_ * ofGradient;
  for (Index i = 0; i < displacement.rows(); ++i)
  {
    displacement.row(i) += ofMean + this->arms_.row(i) * ofP;
  }
}
}
