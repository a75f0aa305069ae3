// SPDX-License-Identifier: BSD-3-Clause
#include "Geometry/RigidFit.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>

namespace morph
{
namespace
{
constexpr double Vanishing = 1e-10; // of the largest singular value
}

Eigen::Matrix3d nearestRotation(const Eigen::Matrix3d& moment)
{
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(moment, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d sigma = svd.singularValues();
  if (!(sigma[0] > 0))
  {
    return Eigen::Matrix3d::Identity();
  }
  if (sigma[1] <= Vanishing * sigma[0])
  {
    // A single direction: the shortest turn.
    return Eigen::Quaterniond::FromTwoVectors(svd.matrixU().col(0), svd.matrixV().col(0))
      .toRotationMatrix();
  }
  Eigen::Matrix3d V = svd.matrixV();
  if ((V * svd.matrixU().transpose()).determinant() < 0)
  {
    V.col(2) *= -1;
  }
  return V * svd.matrixU().transpose();
}

RigidMotion fitRigidMotion(const Points& from, const Points& to)
{
  RigidMotion motion;
  if (from.rows() == 0)
  {
    return motion;
  }
  // Differences from the first point keep the digits of a small body far from the origin.
  motion.from = from.row(0) + (from.rowwise() - from.row(0)).colwise().mean();
  motion.to = to.row(0) + (to.rowwise() - to.row(0)).colwise().mean();
  motion.rotation =
    nearestRotation((from.rowwise() - motion.from).transpose() * (to.rowwise() - motion.to));
  return motion;
}
}
