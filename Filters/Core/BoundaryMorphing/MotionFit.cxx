// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMorphing/MotionFit.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>

namespace morph
{
MotionSums::MotionSums(const BoundaryMotion& motion, const std::vector<Index>& ids)
  : count_(static_cast<double>(ids.size()))
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
    this->center_ += (motion.rest.row(id) - first) / n;
    this->mean_ += motion.displacement.row(id) / n;
  }
  this->center_ += first;
  for (Index id : ids)
  {
    const Eigen::RowVector3d arm = motion.rest.row(id) - this->center_;
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
  const double n = this->count_, m = other.count_;
  const Eigen::RowVector3d arm = other.center_ - this->center_, gain = other.mean_ - this->mean_;
  const double weight = n * m / (n + m);
  this->spread_ += other.spread_ + weight * arm.transpose() * arm;
  this->stretch_ += other.stretch_ + weight * arm.transpose() * gain;
  this->center_ += m / (n + m) * arm;
  this->mean_ += m / (n + m) * gain;
  this->count_ += other.count_;
}

PrincipalDirections MotionSums::directions(const Points& places) const
{
  PrincipalDirections result(this->spread_, this->count_);
  Eigen::RowVector3d reach = Eigen::RowVector3d::Zero();
  for (Index i = 0; i < places.rows(); ++i)
  {
    reach = reach.cwiseMax(result.leverages(places.row(i) - this->center_));
  }
  result.limit(Eigen::RowVector3d::Ones(), reach);
  return result;
}

AffineFit MotionSums::affineFit(const PrincipalDirections& directions) const
{
  return { this->center_, this->mean_, directions.inverse(), this->stretch_ };
}

MotionSums::RigidFit MotionSums::rigidFit(const PrincipalDirections& directions) const
{
  RigidFit fit;
  fit.center_ = this->center_;
  fit.shift_ = this->mean_;
  if (this->stretch_.isZero(0))
  {
    fit.turn_.setZero();
    return fit;
  }
  // Uses displacements in addition to positions, so a small motion keeps its digits.
  Eigen::Matrix3d moment = this->stretch_.transpose() + this->spread_;
  // A line leaves the rotation about itself free: the smallest one that turns the line.
  const Eigen::Vector3d line = directions.axes().col(2);
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(line, moment * line);
  moment += (1 - directions.shares()[1]) * this->spread_.trace() * turn.toRotationMatrix() *
            (Eigen::Matrix3d::Identity() - line * line.transpose());
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(moment, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d sign(
    1, 1, (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1);
  fit.turn_ =
    svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose() - Eigen::Matrix3d::Identity();
  return fit;
}

Eigen::RowVector3d MotionSums::RigidFit::displacement(const Eigen::RowVector3d& x) const
{
  return this->shift_ + (x - this->center_) * this->turn_.transpose();
}

void MotionAround::add(const MotionSums& sums, const PrincipalDirections& directions, double share)
{
  if (!this->empty() && this->left_ > 0)
  {
    this->parts_.back().weight -= this->left_;
  }
  this->parts_.push_back({ sums, directions, this->left_ });
  this->left_ *= 1 - share;
}

template <typename Fit, typename Make>
MotionAround::Mixture<Fit> MotionAround::mixture(const Make& make) const
{
  Mixture<Fit> result;
  for (const Part& part : this->parts_)
  {
    if (part.weight > 0)
    {
      result.parts.emplace_back(part.weight, make(part));
    }
  }
  return result;
}

MotionAround::Mixture<AffineFit> MotionAround::affineFit() const
{
  return this->mixture<AffineFit>(
    [](const Part& part) { return part.sums.affineFit(part.directions); });
}

MotionAround::Mixture<MotionSums::RigidFit> MotionAround::rigidFit() const
{
  return this->mixture<MotionSums::RigidFit>(
    [](const Part& part) { return part.sums.rigidFit(part.directions); });
}

void extrapolate(const MotionAround& around, const std::vector<Index>& nodes, UnattachedMotion how,
  BoundaryMotion& motion)
{
  const auto set = [&](const auto& fit)
  {
    for (Index node : nodes)
    {
      motion.displacement.row(node) = fit.displacement(Eigen::RowVector3d(motion.rest.row(node)));
    }
  };
  if (around.empty() || how == UnattachedMotion::Stay)
  {
    for (Index node : nodes)
    {
      motion.displacement.row(node).setZero();
    }
  }
  else if (how == UnattachedMotion::FollowAffinely)
  {
    set(around.affineFit());
  }
  else
  {
    set(around.rigidFit());
  }
}
}
