// SPDX-License-Identifier: BSD-3-Clause
#include "Formats/CoordinateFrame.h"

#include <cmath>

namespace morph::io
{
namespace
{
const double Degree = std::acos(-1.0) / 180;

/// Without Eigen/Geometry, which this library does not need else.
Eigen::Vector3d cross(const Eigen::Vector3d& a, const Eigen::Vector3d& b)
{
  return { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] };
}
}

Eigen::Vector3d CoordinateFrame::toBasic(const Eigen::Vector3d& local) const
{
  Eigen::Vector3d x = local;
  if (this->kind == Kind::Cylindrical)
  {
    const double angle = local[1] * Degree;
    x << local[0] * std::cos(angle), local[0] * std::sin(angle), local[2];
  }
  else if (this->kind == Kind::Spherical)
  {
    const double toAxis = local[1] * Degree, about = local[2] * Degree;
    x << std::sin(toAxis) * std::cos(about), std::sin(toAxis) * std::sin(about), std::cos(toAxis);
    x *= local[0];
  }
  return this->origin + this->axes * x;
}

Eigen::Vector3d CoordinateFrame::fromBasic(
  const Eigen::Vector3d& basic, const Eigen::Vector3d& old, double precision) const
{
  const Eigen::Vector3d x = this->axes.transpose() * (basic - this->origin);
  Eigen::Vector3d local = x;
  const auto near = [&](double degrees, int j)
  { return degrees + 360 * std::round((old[j] - degrees) / 360); };
  const double about = std::atan2(x[1], x[0]) / Degree, radius = std::hypot(x[0], x[1]);
  if (this->kind == Kind::Cylindrical)
  {
    local << radius, near(about, 1), x[2];
  }
  else if (this->kind == Kind::Spherical)
  {
    local << x.norm(), std::atan2(radius, x[2]) / Degree, near(about, 2);
  }
  for (int j = 0; j < 3; ++j)
  {
    Eigen::Vector3d kept = local;
    kept[j] = old[j];
    local = (this->toBasic(kept) - basic).norm() <= precision ? kept : local;
  }
  return local;
}

CoordinateFrame combined(const CoordinateFrame& outer, const CoordinateFrame& inner)
{
  return { inner.kind, outer.toBasic(inner.origin), outer.axes * inner.axes };
}

std::optional<Eigen::Matrix3d> axesOf(
  const Eigen::Vector3d& origin, const Eigen::Vector3d& along, const Eigen::Vector3d& plane)
{
  Eigen::Matrix3d axes;
  axes.col(0) = (along - origin).normalized();
  const Eigen::Vector3d normal = cross(axes.col(0), plane - origin);
  if (!(normal.norm() > 1e-12 * (plane - origin).norm()))
  {
    return {};
  }
  axes.col(2) = normal.normalized();
  axes.col(1) = cross(axes.col(2), axes.col(0));
  return axes;
}

std::optional<CoordinateFrame> rotationAbout(
  const Eigen::Vector3d& begin, const Eigen::Vector3d& end, double degrees)
{
  const Eigen::Vector3d axis = (end - begin).normalized();
  if (!(axis.norm() > 0.5))
  {
    return {};
  }
  // Whole quarters are exact, so that turned parts keep their round coordinates.
  const double quarters = degrees / 90;
  const bool isExact = quarters == std::round(quarters);
  const double c = isExact ? std::round(std::cos(degrees * Degree)) : std::cos(degrees * Degree);
  const double s = isExact ? std::round(std::sin(degrees * Degree)) : std::sin(degrees * Degree);
  CoordinateFrame frame;
  for (int j = 0; j < 3; ++j)
  {
    const Eigen::Vector3d unit = Eigen::Vector3d::Unit(j);
    frame.axes.col(j) = c * unit + s * cross(axis, unit) + (1 - c) * axis[j] * axis;
  }
  frame.origin = begin - frame.axes * begin;
  return frame;
}
}
