// SPDX-License-Identifier: BSD-3-Clause
#include "MotionFit.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/SVD>

namespace morph
{
namespace
{
Points displacements(const BoundaryMotion& motion, const std::vector<Index>& ids)
{
  Points result(static_cast<Index>(ids.size()), 3);
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    result.row(static_cast<Index>(i)) = motion.displacement.row(ids[i]);
  }
  return result;
}

/// x' = c' + (x - c) R^T, nearest to the motion of `ids`.
struct RigidFit
{
  Eigen::RowVector3d centre = Eigen::RowVector3d::Zero(), shift = centre;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity(); ///< R - I

  RigidFit(const BoundaryMotion& motion, const std::vector<Index>& ids)
  {
    const double n = static_cast<double>(ids.size());
    for (Index id : ids)
    {
      this->centre += motion.rest.row(id) / n;
      this->shift += motion.displacement.row(id) / n;
    }
    // With displacements beside positions a small motion keeps its digits.
    Eigen::Matrix3d Q = Eigen::Matrix3d::Zero(), P = Q;
    for (Index id : ids)
    {
      const Eigen::RowVector3d d = motion.rest.row(id) - this->centre;
      Q += d.transpose() * d;
      P += (motion.displacement.row(id) - this->shift).transpose() * d;
    }
    if (P.isZero(0))
    {
      this->turn.setZero();
      return;
    }
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(P + Q, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Eigen::Vector3d& size = svd.singularValues();
    if (!(size[1] > 1e-10 * size[0]))
    {
      // A line: the turn about its axis is free.
      const Eigen::Quaterniond q =
        Eigen::Quaterniond::FromTwoVectors(svd.matrixV().col(0), svd.matrixU().col(0));
      this->turn = q.toRotationMatrix() - Eigen::Matrix3d::Identity();
      return;
    }
    Eigen::Vector3d sign(
      1, 1, (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1);
    this->turn =
      svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose() - Eigen::Matrix3d::Identity();
  }

  Eigen::RowVector3d displacement(const Eigen::RowVector3d& x) const
  {
    return this->shift + (x - this->centre) * this->turn.transpose();
  }
};
}

Flat::Flat(const Points& rest, const std::vector<Index>& ids)
  : centre_(Eigen::RowVector3d::Zero())
  , normal_(Eigen::Matrix3d::Identity())
{
  for (Index id : ids)
  {
    this->centre_ += rest.row(id) / static_cast<double>(ids.size());
  }
  Eigen::Matrix3d Q = Eigen::Matrix3d::Zero();
  for (Index id : ids)
  {
    const Eigen::RowVector3d d = rest.row(id) - this->centre_;
    Q += d.transpose() * d;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(Q);
  for (int j = 0; j < 3; ++j)
  {
    // As in AffineFit: flatter sets count as planar or straight.
    if (axes.eigenvalues()[j] > 1e-10 * axes.eigenvalues()[2])
    {
      this->normal_ -= axes.eigenvectors().col(j) * axes.eigenvectors().col(j).transpose();
    }
  }
}

double Flat::distance(const Eigen::RowVector3d& x) const
{
  return ((x - this->centre_) * this->normal_).norm();
}

const std::vector<Index>& spanningSet(
  const Points& rest, const std::vector<Index>& nodes, const std::vector<std::vector<Index>>& sets)
{
  static const std::vector<Index> none;
  const double size =
    rest.rows() > 0 ? (rest.colwise().maxCoeff() - rest.colwise().minCoeff()).norm() : 0;
  const std::vector<Index>* last = &none;
  for (const std::vector<Index>& set : sets)
  {
    if (set.empty())
    {
      continue;
    }
    last = &set;
    const Flat flat(rest, set);
    bool holds = true;
    for (Index node : nodes)
    {
      holds = holds && flat.distance(rest.row(node)) <= 1e-9 * size;
    }
    if (holds)
    {
      break;
    }
  }
  return *last;
}

AffineFit affineFit(const BoundaryMotion& motion, const std::vector<Index>& ids)
{
  return AffineFit(motion.rest, ids, displacements(motion, ids));
}

void follow(const std::vector<Index>& ids, const std::vector<Index>& nodes, Unattached how,
  BoundaryMotion& motion)
{
  const auto set = [&](const auto& fit)
  {
    for (Index node : nodes)
    {
      motion.displacement.row(node) = fit.displacement(Eigen::RowVector3d(motion.rest.row(node)));
    }
  };
  if (ids.empty() || how == Unattached::Stay)
  {
    for (Index node : nodes)
    {
      motion.displacement.row(node).setZero();
    }
  }
  else if (how == Unattached::FollowAffinely)
  {
    set(affineFit(motion, ids));
  }
  else
  {
    set(RigidFit(motion, ids));
  }
}
}
