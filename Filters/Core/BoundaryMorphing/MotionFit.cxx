// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMorphing/MotionFit.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/SVD>

namespace morph
{
MotionSums::MotionSums(const BoundaryMotion& motion, const std::vector<Index>& ids)
  : count_(static_cast<Index>(ids.size()))
{
  if (ids.empty())
  {
    return;
  }
  // Sum differences: sums of coordinates far from the origin would lose the digits that tell the
  // nodes apart.
  const double n = static_cast<double>(ids.size());
  const Eigen::RowVector3d first = motion.rest.row(ids[0]);
  for (Index id : ids)
  {
    this->centre_ += (motion.rest.row(id) - first) / n;
    this->mean_ += motion.displacement.row(id) / n;
  }
  this->centre_ += first;
  for (Index id : ids)
  {
    const Eigen::RowVector3d arm = motion.rest.row(id) - this->centre_;
    this->spread_ += arm.transpose() * arm;
    this->stretch_ += arm.transpose() * (motion.displacement.row(id) - this->mean_);
  }
}

void MotionSums::add(const MotionSums& other)
{
  if (this->empty() || other.empty())
  {
    *this = this->empty() ? other : *this;
    return;
  }
  // Chan, Golub, LeVeque (The American Statistician 37 (1983) 242-247): free of cancellation.
  const double n = static_cast<double>(this->count_), m = static_cast<double>(other.count_);
  const Eigen::RowVector3d arm = other.centre_ - this->centre_, gain = other.mean_ - this->mean_;
  const double weight = n * m / (n + m);
  this->spread_ += other.spread_ + weight * arm.transpose() * arm;
  this->stretch_ += other.stretch_ + weight * arm.transpose() * gain;
  this->centre_ += m / (n + m) * arm;
  this->mean_ += m / (n + m) * gain;
  this->count_ += other.count_;
}

AffineSpan::AffineSpan(const Eigen::RowVector3d& centre, const Eigen::Matrix3d& spread)
  : centre_(centre)
  , normal_(Eigen::Matrix3d::Identity())
{
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
  for (int j = 0; j < 3; ++j)
  {
    if (AffineLeastSquares::isExtended(axes.eigenvalues()[j], axes.eigenvalues()[2]))
    {
      this->normal_ -= axes.eigenvectors().col(j) * axes.eigenvectors().col(j).transpose();
    }
  }
}

double AffineSpan::distance(const Eigen::RowVector3d& x) const
{
  return ((x - this->centre_) * this->normal_).norm();
}

AffineFit MotionSums::affineFit() const
{
  return AffineFit(this->centre_, this->mean_, this->spread_, this->stretch_);
}

MotionSums::RigidFit MotionSums::rigidFit() const
{
  RigidFit fit;
  fit.centre_ = this->centre_;
  fit.shift_ = this->mean_;
  if (this->stretch_.isZero(0))
  {
    fit.turn_.setZero();
    return fit;
  }
  // Uses displacements in addition to positions, so a small motion keeps its digits.
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(
    this->stretch_.transpose() + this->spread_, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d& size = svd.singularValues();
  if (!(size[1] > 1e-10 * size[0]))
  {
    // A line: the rotation about its axis is free.
    const Eigen::Quaterniond q =
      Eigen::Quaterniond::FromTwoVectors(svd.matrixV().col(0), svd.matrixU().col(0));
    fit.turn_ = q.toRotationMatrix() - Eigen::Matrix3d::Identity();
    return fit;
  }
  const Eigen::Vector3d sign(
    1, 1, (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1);
  fit.turn_ =
    svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose() - Eigen::Matrix3d::Identity();
  return fit;
}

Eigen::RowVector3d MotionSums::RigidFit::displacement(const Eigen::RowVector3d& x) const
{
  return this->shift_ + (x - this->centre_) * this->turn_.transpose();
}

AffineFit affineFit(const BoundaryMotion& motion, const std::vector<Index>& ids)
{
  return MotionSums(motion, ids).affineFit();
}

void extrapolate(const MotionSums& sums, const std::vector<Index>& nodes, UnattachedMotion how,
  BoundaryMotion& motion)
{
  const auto set = [&](const auto& fit)
  {
    for (Index node : nodes)
    {
      motion.displacement.row(node) = fit.displacement(Eigen::RowVector3d(motion.rest.row(node)));
    }
  };
  if (sums.empty() || how == UnattachedMotion::Stay)
  {
    for (Index node : nodes)
    {
      motion.displacement.row(node).setZero();
    }
  }
  else if (how == UnattachedMotion::FollowAffinely)
  {
    set(sums.affineFit());
  }
  else
  {
    set(sums.rigidFit());
  }
}
}
