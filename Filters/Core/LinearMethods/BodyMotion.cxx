// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/BodyMotion.h"

#include "Geometry/AffineFit.h"
#include "Geometry/ThinSvd3.h"

#include <Eigen/Geometry>

#include <cmath>

namespace morph
{
namespace
{
constexpr double Affine = 1e-9; // of the mesh's size: rounding of an affine motion

/// Returns I + gradient where the points determine it, completed by a similarity elsewhere.
/// Positions are rows.
Eigen::Matrix3d completed(
  const AffineLeastSquares& points, const Points& arms, const AffineFit& fit)
{
  Eigen::Matrix3d map = Eigen::Matrix3d::Identity() + fit.gradient();
  const Eigen::Matrix3d axes = ThinSvd3(arms).axes;
  if (points.rank() == 2)
  {
    const Eigen::Vector3d normal = axes.col(0).cross(axes.col(1));
    const Eigen::Vector3d a = map.transpose() * axes.col(0), b = map.transpose() * axes.col(1);
    const Eigen::Vector3d moved = a.cross(b);
    if (moved.norm() > 0)
    {
      // The thickness scales with the sheet's lengths.
      map += normal * (moved / std::sqrt(moved.norm()) - normal).transpose();
    }
  }
  else if (points.rank() == 1)
  {
    const Eigen::Vector3d line = axes.col(0), moved = map.transpose() * line;
    if (moved.norm() > 0)
    {
      const auto turn = Eigen::Quaterniond::FromTwoVectors(line, moved);
      map = moved.norm() * turn.toRotationMatrix().transpose();
    }
  }
  return map;
}

/// Returns for each body the rows of `all` that belong to it.
std::vector<std::vector<Index>> prescribedOfBodies(
  const ConnectedComponents& bodies, const NodePartition& partition)
{
  std::vector<std::vector<Index>> result(bodies.count);
  for (std::size_t i = 0; i < partition.prescribed.size(); ++i)
  {
    const Index body = bodies.ofNode[partition.prescribed[i]];
    if (body >= 0)
    {
      result[body].push_back(static_cast<Index>(i));
    }
  }
  return result;
}

struct Motion
{
  Eigen::RowVector3d centre = Eigen::RowVector3d::Zero(), mean = Eigen::RowVector3d::Zero();
  Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();

  template <typename Row>
  Eigen::RowVector3d at(const Row& x) const
  {
    return this->mean + (x - this->centre) * this->gradient;
  }
};

Motion motionOf(const Points& rest, const Points& displacement)
{
  Motion motion;
  if (rest.rows() == 0 || (displacement.array() == 0).all())
  {
    return motion;
  }
  motion.centre = rest.colwise().mean();
  const AffineLeastSquares squares(rest);
  const AffineFit fit = squares.fit(displacement);
  motion.mean = fit.displacement(motion.centre);
  motion.gradient = fit.gradient();
  if (squares.rank() < 3)
  {
    motion.gradient =
      completed(squares, rest.rowwise() - motion.centre, fit) - Eigen::Matrix3d::Identity();
  }
  return motion;
}
}

bool followAffinely(
  const Mesh& rest, const NodePartition& partition, const Points& displacement, Points& points)
{
  const ConnectedComponents parts = connectedComponents(rest);
  const std::vector<std::vector<Index>> prescribed = prescribedOfBodies(parts, partition);
  const double size =
    rest.points.rows() > 0
      ? (rest.points.colwise().maxCoeff() - rest.points.colwise().minCoeff()).norm()
      : 0;
  std::vector<Motion> motions(parts.count);
  bool isAffine = true;
  for (Index body = 0; body < parts.count; ++body)
  {
    const auto count = static_cast<Index>(prescribed[body].size());
    Points x(count, 3), u(count, 3);
    for (Index i = 0; i < count; ++i)
    {
      x.row(i) = rest.points.row(partition.prescribed[prescribed[body][i]]);
      u.row(i) = displacement.row(prescribed[body][i]);
    }
    motions[body] = motionOf(x, u);
    const double scale = std::max(size, u.rows() > 0 ? u.cwiseAbs().maxCoeff() : 0);
    for (Index i = 0; i < count && isAffine; ++i)
    {
      isAffine = (motions[body].at(x.row(i)) - u.row(i)).norm() <= Affine * scale;
    }
  }
  for (Index node : partition.free)
  {
    const Motion& motion = motions[parts.ofNode[node]];
    const Eigen::RowVector3d x = rest.points.row(node), u = motion.at(x);
    points.row(node) = (u.array() == 0).all() ? x : Eigen::RowVector3d(x + u);
  }
  return isAffine;
}
}
