// SPDX-License-Identifier: BSD-3-Clause
#include "AffineFit.h"

#include <Eigen/Eigenvalues>

#include <algorithm>

namespace morph
{
namespace
{
Points rowsOf(const Points& all, const std::vector<Index>& ids)
{
  Points some(static_cast<Index>(ids.size()), 3);
  for (Index i = 0; i < some.rows(); ++i)
  {
    some.row(i) = all.row(ids[i]);
  }
  return some;
}

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
}

AffineFit::AffineFit(const Points& rest, const std::vector<Index>& ids, const Points& displacement)
  : AffineFit(AffineLeastSquares(rowsOf(rest, ids)).fit(displacement))
{
}

AffineLeastSquares::AffineLeastSquares(const Points& rest)
{
  this->centre_ = meanOfRows(rest);
  this->arms_ = rest.rowwise() - this->centre_;
  Eigen::Matrix3d Q = Eigen::Matrix3d::Zero();
  for (Index i = 0; i < rest.rows(); ++i)
  {
    Q.noalias() += this->arms_.row(i).transpose() * this->arms_.row(i);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(Q);
  Eigen::Vector3d inverse = Eigen::Vector3d::Zero();
  for (int j = 0; j < 3; ++j)
  {
    // A ratio of 1e-5 in extent: flatter sets count as planar or straight.
    if (axes.eigenvalues()[j] > 1e-10 * axes.eigenvalues()[2])
    {
      inverse[j] = 1 / axes.eigenvalues()[j];
      ++this->rank_;
    }
  }
  this->inverse_ = axes.eigenvectors() * inverse.asDiagonal() * axes.eigenvectors().transpose();
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
  // The arms sum to zero, so that the mean within P needs no term of its own.
  const Eigen::Matrix3d ofP = this->inverse_ * ofGradient;
  for (Index i = 0; i < displacement.rows(); ++i)
  {
    displacement.row(i) += ofMean + this->arms_.row(i) * ofP;
  }
}
}
