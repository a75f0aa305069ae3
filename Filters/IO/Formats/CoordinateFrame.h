// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

#include <optional>

namespace morph::io
{
/// A coordinate system in which a file has positions. Angles are in degrees.
struct CoordinateFrame
{
  enum class Kind
  {
    Rectangular,
    Cylindrical, ///< radius, angle about the third axis, height
    Spherical,   ///< radius, angle to the third axis, angle about it
  };

  Kind kind = Kind::Rectangular;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity(); ///< its columns: unit vectors

  bool operator==(const CoordinateFrame& other) const
  {
    return this->kind == other.kind && this->origin == other.origin && this->axes == other.axes;
  }
  Eigen::Vector3d toBasic(const Eigen::Vector3d& local) const;
  /// The coordinates of a position. Those that may stay as `old` within `precision`, a length,
  /// do, and angles are as near to `old` as whole turns allow.
  Eigen::Vector3d fromBasic(
    const Eigen::Vector3d& basic, const Eigen::Vector3d& old, double precision) const;
};

/// `inner` is given in `outer`, which is rectangular.
CoordinateFrame combined(const CoordinateFrame& outer, const CoordinateFrame& inner);

/// Orthonormal axes: the first from `origin` to `along`, the second towards `plane`. Nothing where
/// the three points are on a line.
std::optional<Eigen::Matrix3d> axesOf(
  const Eigen::Vector3d& origin, const Eigen::Vector3d& along, const Eigen::Vector3d& plane);

/// The rotation about the axis from `begin` to `end`, in degrees. Nothing where these are equal.
std::optional<CoordinateFrame> rotationAbout(
  const Eigen::Vector3d& begin, const Eigen::Vector3d& end, double degrees);
}
