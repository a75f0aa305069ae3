// SPDX-License-Identifier: BSD-3-Clause
#include "Geometry/RotationFit.h"
#include "Meshes.h"
#include "Motions.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace morph;

namespace
{
Points turned(const Points& points, const AxisRotation& rotation, double factor)
{
  const double angle = factor * rotation.angle;
  Points result = points;
  for (Index i = 0; i < points.rows(); ++i)
  {
    result.row(i) += std::sin(angle) * rotation.first(points.row(i)) +
                     (1 - std::cos(angle)) * rotation.second(points.row(i));
  }
  return result;
}

std::string messageOf(const Points& from, const Points& to)
{
  std::string message;
  motions::kindOf([&] { fitRotation(from, to, 1e-9); }, message);
  return message;
}
}

TEST(RotationFit, FindsTheAxisAndTheAngle)
{
  std::mt19937 random(meshes::seed());
  std::uniform_real_distribution<double> number(-1, 1);
  for (int run = 0; run < 100; ++run)
  {
    const Points from = meshes::randomPoints(run % 2 ? 3 : 50, random);
    const Eigen::Vector3d axis =
      Eigen::Vector3d(number(random), number(random), number(random)).normalized();
    const Eigen::RowVector3d center(number(random), number(random), number(random));
    const double angle = 1e-3 + (M_PI - 2e-3) * (number(random) + 1) / 2;
    const Eigen::Matrix3d R = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
    const Points to = ((from.rowwise() - center) * R.transpose()).rowwise() + center;
    const AxisRotation found = fitRotation(from, to, 1e-9);
    EXPECT_NEAR(found.angle, angle, 1e-10);
    EXPECT_LT((found.axis - axis.transpose()).norm(), 1e-9);
    EXPECT_LT(axis.cross(Eigen::Vector3d((found.center - center).transpose())).norm(), 1e-9);
    EXPECT_LT(motions::difference(turned(from, found, 1), to), 1e-10);
    // Half of the motion, twice, is the motion.
    EXPECT_LT(motions::difference(turned(turned(from, found, .5), found, .5), to), 1e-10);
  }
}

TEST(RotationFit, RefusesOtherMotions)
{
  std::mt19937 random(meshes::seed());
  const Points from = meshes::randomPoints(20, random);
  const Eigen::Matrix3d R = Eigen::AngleAxisd(.7, Eigen::Vector3d::UnitY()).toRotationMatrix();
  const Points to = from * R.transpose();
  EXPECT_NE(messageOf(from, 1.1 * to).find("not rigid"), std::string::npos);
  Points mirrored = to;
  mirrored.col(0) *= -1;
  EXPECT_NE(messageOf(from, mirrored).find("not rigid"), std::string::npos);
  EXPECT_NE(messageOf(from, to.rowwise() + Eigen::RowVector3d(0, .25, 0)).find("axis, by 0.25"),
    std::string::npos);
  EXPECT_NE(
    messageOf(from, from.rowwise() + Eigen::RowVector3d(1, 2, 3)).find("shift"), std::string::npos);
  EXPECT_NE(messageOf(from.topRows(2), to.topRows(2)).find("fewer than three"), std::string::npos);
  Points line = from;
  line.rightCols(2).setZero();
  EXPECT_NE(messageOf(line, line * R.transpose()).find("one line"), std::string::npos);
}
