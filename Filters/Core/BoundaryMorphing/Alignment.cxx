// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMorphing/Alignment.h"

#include "Support/ProgressRange.h"

#include <Eigen/Eigenvalues>

#include <cmath>
#include <limits>

namespace morph
{
namespace
{
using Vector = Eigen::Vector3d;
using Rigid = Eigen::Isometry3d;

constexpr Index Landmarks = 500;
constexpr int Iterations = 100;
/// To find the best start.
constexpr Index FewLandmarks = 100;
constexpr int FewIterations = 30;
/// Iterations end where one moves the landmarks by less, root mean square, of the place's size.
constexpr double Still = 1e-9;

/// Center of area and principal axes of a surface.
struct Moments
{
  Vector center = Vector::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity(); ///< right-handed, by ascending variance
};

Moments momentsOf(const TriangleTree& surface)
{
  Moments moments;
  std::vector<std::pair<Vector, double>> triangles; ///< center and area
  double area = 0;
  for (const auto& [a, b, c] : surface.triangles())
  {
    triangles.emplace_back((a + b + c).transpose() / 3, (b - a).cross(c - a).norm() / 2);
    area += triangles.back().second;
    moments.center += triangles.back().second * triangles.back().first;
  }
  if (area == 0)
  {
    return moments;
  }
  moments.center /= area;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const auto& [center, weight] : triangles)
  {
    const Vector x = center - moments.center;
    covariance += weight * x * x.transpose();
  }
  moments.axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvectors();
  if (moments.axes.determinant() < 0)
  {
    moments.axes.col(0) *= -1;
  }
  return moments;
}

std::vector<Rigid> startsOf(const Moments& from, const Moments& to)
{
  const auto about = [&](const Eigen::Matrix3d& rotation)
  {
    Rigid start = Rigid::Identity();
    start.linear() = rotation;
    start.translation() = to.center - rotation * from.center;
    return start;
  };
  std::vector<Rigid> starts = { Rigid::Identity(), about(Eigen::Matrix3d::Identity()) };
  const Vector signs[] = { { 1, 1, 1 }, { 1, -1, -1 }, { -1, 1, -1 }, { -1, -1, 1 } };
  for (const Vector& sign : signs)
  {
    starts.push_back(about(to.axes * sign.asDiagonal() * from.axes.transpose()));
  }
  return starts;
}

/// At most about `most` of the points, evenly from all.
std::vector<Vector> someOf(const Points& points, Index most)
{
  std::vector<Vector> some;
  for (Index i = 0; i < points.rows(); i += 1 + points.rows() / most)
  {
    some.emplace_back(points.row(i).transpose());
  }
  return some;
}

/// The surface onto which another one is turned and shifted.
struct Place
{
  const TriangleTree& triangles;
  double size; ///< diagonal of its box

  Vector closest(const Vector& x) const
  {
    return this->triangles.nearest(x.transpose(), std::numeric_limits<double>::infinity())
      .place.transpose();
  }
};

double sizeOf(const TriangleTree& surface)
{
  Eigen::AlignedBox3d box;
  for (const TriangleTree::Triangle& triangle : surface.triangles())
  {
    for (const TriangleTree::Row& corner : triangle)
    {
      box.extend(corner.transpose());
    }
  }
  return box.diagonal().norm();
}

/// The motion after closest-point iterations from a start: each takes the landmarks as near as
/// rigid motion can to their closest points.
Rigid iterated(const std::vector<Vector>& landmarks, const Rigid& start, const Place& place,
  int iterations, Monitor& monitor)
{
  Rigid motion = start;
  const auto count = static_cast<Eigen::Index>(landmarks.size());
  Eigen::Matrix3Xd from(3, count), to(3, count);
  double moved = std::numeric_limits<double>::infinity();
  for (int done = 0; done < iterations && moved > Still * place.size; ++done)
  {
    monitor.check();
    monitor.progress(static_cast<double>(done) / iterations);
    for (Eigen::Index i = 0; i < count; ++i)
    {
      from.col(i) = motion * landmarks[i];
      to.col(i) = place.closest(from.col(i));
    }
    const Rigid step(Eigen::umeyama(from, to, false));
    motion = step * motion;
    moved = std::sqrt((step * from - from).colwise().squaredNorm().mean());
  }
  monitor.progress(1);
  return motion;
}

double meanDistance(const std::vector<Vector>& landmarks, const Rigid& motion, const Place& place)
{
  double sum = 0;
  for (const Vector& x : landmarks)
  {
    const Vector y = motion * x;
    sum += (place.closest(y) - y).norm();
  }
  return sum / static_cast<double>(landmarks.size());
}
}

Rigid alignment(
  const TriangleTree& surface, const Points& landmarks, const TriangleTree& onto, Monitor& monitor)
{
  const Place place{ onto, sizeOf(onto) };
  const std::vector<Vector> few = someOf(landmarks, FewLandmarks);
  Rigid best = Rigid::Identity();
  double least = -1;
  const std::vector<Rigid> starts = startsOf(momentsOf(surface), momentsOf(onto));
  for (std::size_t i = 0; i < starts.size(); ++i)
  {
    const double share = 0.5 / static_cast<double>(starts.size());
    const double done = share * static_cast<double>(i);
    ProgressRange part(monitor, done, done + share);
    const Rigid motion = iterated(few, starts[i], place, FewIterations, part);
    const double distance = meanDistance(few, motion, place);
    if (motion.matrix().allFinite() && (least < 0 || distance < 0.99 * least - 1e-6 * place.size))
    {
      least = distance;
      best = motion;
    }
  }
  ProgressRange last(monitor, 0.5, 1);
  return iterated(someOf(landmarks, Landmarks), best, place, Iterations, last);
}
}
