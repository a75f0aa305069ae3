// SPDX-License-Identifier: BSD-3-Clause
#include "AffineFit.h"

#include <Eigen/Eigenvalues>

namespace morph
{
AffineFit::AffineFit(
  const Points& rest, const std::vector<Index>& ids, const Points& displacement)
  : centre_(Eigen::RowVector3d::Zero())
  , mean_(Eigen::RowVector3d::Zero())
{
  const Index n = static_cast<Index>(ids.size());
  for (Index i = 0; i < n; ++i)
  {
    this->centre_ += rest.row(ids[i]);
    this->mean_ += displacement.row(i);
  }
  this->centre_ /= static_cast<double>(n);
  this->mean_ /= static_cast<double>(n);

  Eigen::Matrix3d Q = Eigen::Matrix3d::Zero(), P = Q;
  for (Index i = 0; i < n; ++i)
  {
    const Eigen::RowVector3d d = rest.row(ids[i]) - this->centre_;
    Q.noalias() += d.transpose() * d;
    P.noalias() += d.transpose() * (displacement.row(i) - this->mean_);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(Q);
  Eigen::Vector3d inverse = Eigen::Vector3d::Zero();
  for (int j = 0; j < 3; ++j)
  {
    // A ratio of 1e-5 in extent: flatter sets count as planar or straight.
    if (axes.eigenvalues()[j] > 1e-10 * axes.eigenvalues()[2])
    {
      inverse[j] = 1 / axes.eigenvalues()[j];
    }
  }
  this->gradient_ =
    axes.eigenvectors() * inverse.asDiagonal() * axes.eigenvectors().transpose() * P;
}
}
