// SPDX-License-Identifier: BSD-3-Clause
#include "Geometry/RotationFit.h"

#include "Geometry/ThinSvd3.h"
#include "Support/Error.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>

#include <cmath>
#include <sstream>

namespace morph
{
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
