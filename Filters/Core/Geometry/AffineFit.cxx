// SPDX-License-Identifier: BSD-3-Clause
#include "Geometry/AffineFit.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <tuple>
#include <utility>

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

/// Returns the pseudo-inverse of second moments, and their rank.
std::pair<Eigen::Matrix3d, int> pseudoInverse(const Eigen::Matrix3d& moments)
{
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(moments);
  Eigen::Vector3d inverse = Eigen::Vector3d::Zero();
  int rank = 0;
  for (int j = 0; j < 3; ++j)
  {
    if (AffineLeastSquares::isExtended(axes.eigenvalues()[j], axes.eigenvalues()[2]))
    {
      inverse[j] = 1 / axes.eigenvalues()[j];
      ++rank;
    }
  }
  return { axes.eigenvectors() * inverse.asDiagonal() * axes.eigenvectors().transpose(), rank };
}
}

AffineFit::AffineFit(const Eigen::RowVector3d& centre, const Eigen::RowVector3d& mean,
  const Eigen::Matrix3d& spread, const Eigen::Matrix3d& stretch)
  : centre_(centre)
  , mean_(mean)
  , gradient_(pseudoInverse(spread).first * stretch)
{
}

AffineLeastSquares::AffineLeastSquares(const Points& rest)
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
  this->centre_ = first + middle;
  this->arms_.rowwise() -= middle;
  Eigen::Matrix3d Q = Eigen::Matrix3d::Zero();
  for (Index i = 0; i < rest.rows(); ++i)
  {
    Q.noalias() += this->arms_.row(i).transpose() * this->arms_.row(i);
  }
  std::tie(this->inverse_, this->rank_) = pseudoInverse(Q);
}

AffineFit AffineLeastSquares::fit(const Points& displacement) const
{
  AffineFit fit;
  fit.centre_ = this->centre_;
  fit.mean_ = meanOfRows(displacement);
  Eigen::Matrix3d P = Eigen::Matrix3d::Zero();
  for (Index i = 0; i < displacement.rows(); ++i)
  {
    P.noalias() += this->arms_.row(i).transpose() * (displacement.row(i) - fit.mean_);
  }
  fit.gradient_ = this->inverse_ * P;
  return fit;
}

void AffineLeastSquares::fitTranspose(
  const Points& x, const Points& gradient, Points& displacement) const
{
  const Eigen::RowVector3d ofMean = sumOfRows(gradient) / static_cast<double>(displacement.rows());
  Eigen::Matrix3d ofGradient = Eigen::Matrix3d::Zero();
  for (Index i = 0; i < x.rows(); ++i)
  {
    ofGradient.noalias() += (x.row(i) - this->centre_).transpose() * gradient.row(i);
  }
  // The arms sum to zero, so the mean within P adds no term.
  const Eigen::Matrix3d ofP = this->inverse_ * ofGradient;
  for (Index i = 0; i < displacement.rows(); ++i)
  {
    displacement.row(i) += ofMean + this->arms_.row(i) * ofP;
  }
}
}
