// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMorphing/KnownMotion.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>

#include <algorithm>
#include <iterator>
#include <limits>

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

namespace
{
std::vector<Index> knownOf(const std::vector<Index>& nodes, const BoundaryMotion& motion)
{
  std::vector<Index> known;
  std::copy_if(nodes.begin(), nodes.end(), std::back_inserter(known),
    [&](Index node) { return motion.state[node] != BoundaryMotion::Unknown; });
  return known;
}

/// The distance below which a node lies in an affine span: 1e-9 of the model's size, or the
/// rounding of distant coordinates.
double flatTolerance(const Points& rest)
{
  if (rest.rows() == 0)
  {
    return 0;
  }
  const double size = (rest.colwise().maxCoeff() - rest.colwise().minCoeff()).norm();
  return 1e-9 * size + 8 * std::numeric_limits<double>::epsilon() * rest.cwiseAbs().maxCoeff();
}
}

KnownMotion::KnownMotion(const Classification& geometry, const BoundaryMotion& motion)
  : motion_(motion)
  , tolerance_(flatTolerance(motion.rest))
{
  for (const GeometrySurface& surface : geometry.surfaces)
  {
    this->ofSurface_.push_back(knownOf(surface.nodes, motion));
  }
  this->surface_.resize(this->ofSurface_.size());
}

const MotionSums& KnownMotion::ofSurface(Index surface)
{
  std::optional<MotionSums>& sums = this->surface_[surface];
  if (!sums)
  {
    sums = this->sumOf(this->ofSurface_[surface]);
  }
  return *sums;
}

void KnownMotion::sumBodies()
{
  if (!this->body_.empty())
  {
    return;
  }
  std::vector<std::vector<Index>> ofBody(1);
  for (Index node : this->motion_.known())
  {
    const std::size_t body = static_cast<std::size_t>(this->motion_.bodyOfNode[node] + 1);
    ofBody.resize(std::max(ofBody.size(), body + 1));
    ofBody[body].push_back(node);
  }
  for (const std::vector<Index>& nodes : ofBody)
  {
    this->body_.push_back(this->sumOf(nodes));
  }
}

MotionSums KnownMotion::sumOf(const std::vector<Index>& ids)
{
  this->summed_ += static_cast<Index>(ids.size());
  return MotionSums(this->motion_, ids);
}

/// Adds a nonempty set by the share of the directions in which the places leave its center.
void KnownMotion::add(const MotionSums& sums, const Points& places, MotionAround& around) const
{
  if (sums.empty())
  {
    return;
  }
  const PrincipalDirections directions = sums.directions(places);
  const Points arms = (places.rowwise() - sums.center()) * directions.axes();
  double share = 1;
  for (int j = 0; j < 3; ++j)
  {
    if (arms.col(j).cwiseAbs().maxCoeff() > this->tolerance_)
    {
      share = std::min(share, directions.shares()[j]);
    }
  }
  around.add(sums, directions, share);
}

const MotionSums& KnownMotion::besides(const GeometryCurve& curve)
{
  const auto found = this->besides_.find(curve.surfaces);
  if (found != this->besides_.end())
  {
    return found->second;
  }
  std::vector<Index> order = curve.surfaces;
  std::stable_sort(order.begin(), order.end(),
    [&](Index a, Index b) { return this->ofSurface_[a].size() > this->ofSurface_[b].size(); });
  MotionSums sums;
  for (auto surface = order.begin(); surface != order.end(); ++surface)
  {
    if (surface == order.begin())
    {
      sums = this->ofSurface(*surface);
      continue;
    }
    std::vector<Index> others; // known nodes that the larger sets do not have
    for (Index node : this->ofSurface_[*surface])
    {
      const auto has = [&](Index larger)
      {
        const std::vector<Index>& nodes = this->ofSurface_[larger];
        return std::binary_search(nodes.begin(), nodes.end(), node);
      };
      if (std::none_of(order.begin(), surface, has))
      {
        others.push_back(node);
      }
    }
    sums.add(this->sumOf(others));
  }
  return this->besides_.emplace(curve.surfaces, sums).first->second;
}

MotionAround KnownMotion::around(const GeometryCurve& curve)
{
  const Points places = this->motion_.rest(curve.nodes, allColumns);
  MotionAround around;
  this->add(this->sumOf(knownOf(curve.nodes, this->motion_)), places, around);
  if (around.left() > 0)
  {
    this->add(this->besides(curve), places, around);
  }
  if (around.left() > 0)
  {
    this->addBody(this->motion_.bodyOfNode[curve.nodes[0]], places, around);
  }
  return around;
}

MotionAround KnownMotion::around(Index body, const std::vector<Index>& nodes)
{
  MotionAround around;
  this->addBody(body, this->motion_.rest(nodes, allColumns), around);
  return around;
}

void KnownMotion::addBody(Index body, const Points& places, MotionAround& around)
{
  this->sumBodies();
  const std::size_t place = static_cast<std::size_t>(body + 1);
  if (place < this->body_.size())
  {
    this->add(this->body_[place], places, around);
  }
}
}
