// SPDX-License-Identifier: BSD-3-Clause
#include "Geometry/RotationFit.h"

#include "Support/Error.h"

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <sstream>

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

ThinSvd3::ThinSvd3(const ConstPoints& vectors)
  : dimension(0)
{
  constexpr double RankTolerance = 1e-11;
  Eigen::MatrixXd tall = Eigen::MatrixXd::Zero(std::max<Index>(vectors.rows(), 3), 3);
  tall.topRows(vectors.rows()) = vectors;
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(tall);
  const Eigen::MatrixXd R = qr.matrixQR().topRows<3>().triangularView<Eigen::Upper>();
  const Eigen::JacobiSVD<Eigen::MatrixXd, Eigen::NoQRPreconditioner> svd(R, Eigen::ComputeFullV);
  this->extent = svd.singularValues();
  this->axes = qr.colsPermutation() * svd.matrixV();
  for (int c = 0; c < 3; ++c)
  {
    this->dimension += this->extent[c] > RankTolerance * this->extent[0];
  }
}

namespace
{
/// Below this angle in radians the place of the axis is rounding.
constexpr double SmallestAngle = 1e-7;

Eigen::Matrix3d rotationOf(const Points& before, const Points& after)
{
  const Eigen::Matrix3d moments = after.transpose() * before;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(moments, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs = Eigen::Vector3d::Ones();
  signs[2] = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

[[noreturn]] void refuse(const char* fault, double amount)
{
  std::ostringstream text;
  text << "The motion " << fault << " by " << amount << ".";
  throw Error(text.str());
}
}

AxisRotation fitRotation(const Points& from, const Points& to, double tolerance)
{
  if (from.rows() < 3)
  {
    throw Error("The motion moves fewer than three points.");
  }
  const Eigen::RowVector3d before = from.colwise().mean(), after = to.colwise().mean();
  const Points arms = from.rowwise() - before;
  if (ThinSvd3(arms).extent[1] <= tolerance)
  {
    throw Error("The motion moves points of one line only.");
  }
  const Eigen::Matrix3d R = rotationOf(arms, to.rowwise() - after);
  const Points turned = arms * R.transpose();
  const double misfit = ((turned.rowwise() + after) - to).rowwise().norm().maxCoeff();
  if (!(misfit <= tolerance))
  {
    refuse("is not rigid: its points are off the best rigid motion", misfit);
  }
  const Eigen::AngleAxisd turn(R);
  AxisRotation result;
  result.axis = turn.axis().transpose();
  result.angle = turn.angle();
  if (!(result.angle > SmallestAngle))
  {
    throw Error("The motion is a shift without a rotation.");
  }
  const Eigen::RowVector3d shift = after - before;
  const double slide = shift.dot(result.axis);
  if (!(std::abs(slide) <= tolerance))
  {
    refuse("also slides along its axis,", std::abs(slide));
  }
  const Eigen::RowVector3d across = shift - slide * result.axis;
  result.center =
    before + across / 2 + result.axis.cross(across) / (2 * std::tan(result.angle / 2));
  return result;
}
}
