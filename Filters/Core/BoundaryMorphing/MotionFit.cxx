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

AffineFit MotionSums::rigidFit(const PrincipalDirections& directions) const
{
  const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
  if (this->stretch_.isZero(0))
  {
    return { this->center_, this->mean_, one, Eigen::Matrix3d::Zero() };
  }
  // Uses displacements in addition to positions, so a small motion keeps its digits.
  Eigen::Matrix3d moment = this->stretch_.transpose() + this->spread_;
  // A line leaves the rotation about itself free: the smallest one that turns the line.
  const Eigen::Vector3d line = directions.axes().col(2);
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(line, moment * line);
  moment += (1 - directions.shares()[1]) * this->spread_.trace() * turn.toRotationMatrix() *
            (one - line * line.transpose());
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(moment, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d sign(
    1, 1, (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1);
  const Eigen::Matrix3d change =
    svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose() - one; // R - I
  return { this->center_, this->mean_, one, change.transpose() };
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

MotionAround::Mixture MotionAround::mixture(
  AffineFit (MotionSums::*fit)(const PrincipalDirections& directions) const) const
{
  Mixture result;
  for (const Part& part : this->parts_)
  {
    if (part.weight > 0)
    {
      result.parts.emplace_back(part.weight, (part.sums.*fit)(part.directions));
    }
  }
  return result;
}

void extrapolate(const MotionAround& around, const std::vector<Index>& nodes, UnattachedMotion how,
  BoundaryMotion& motion)
{
  const MotionAround::Mixture fit = how == UnattachedMotion::Stay ? MotionAround::Mixture()
                                    : how == UnattachedMotion::FollowAffinely ? around.affineFit()
                                                                              : around.rigidFit();
  for (const Index node : nodes)
  {
    motion.displacement.row(node) = fit.displacement(motion.rest.row(node));
  }
}
}
