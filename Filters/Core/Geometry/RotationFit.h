// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

#include <Eigen/Geometry>

namespace morph
{
/// A motion without change of shape: x goes to (x - from) R^T + to.
struct RigidMotion
{
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity(); ///< R, determinant 1
  Eigen::RowVector3d from = Eigen::RowVector3d::Zero();
  Eigen::RowVector3d to = Eigen::RowVector3d::Zero();

  template <typename Row>
  Eigen::RowVector3d operator()(const Row& x) const
  {
    return (x - this->from) * this->rotation.transpose() + this->to;
  }
};

/// Returns the rotation R that minimizes the sum of |y - R x|^2 over pairs of vectors. `moment`:
/// the sum of x y^T, x and y as columns. Where the vectors determine it only about an axis, the
/// smallest such rotation. Source: Kabsch, Acta Cryst. A32 (1976) 922-923.
Eigen::Matrix3d nearestRotation(const Eigen::Matrix3d& moment);

/// Returns the rigid motion that takes the rows of `from` nearest to those of `to`, by least
/// squares; both #points x 3. Points on a line leave the turn about it open: the smallest. No point
/// tells no motion: the identity. Cost: two passes.
RigidMotion fitRigidMotion(const Points& from, const Points& to);

/// Singular values and right singular vectors of a k x 3 matrix, largest first. An orthogonal
/// factorisation keeps the digits that a sum of squares would lose. So it resolves extents down to
/// 1e-15 of the largest.
struct ThinSvd3
{
  /// `vectors`: k x 3, finite.
  explicit ThinSvd3(const ConstPoints& vectors);

  Eigen::Vector3d extent; ///< singular values
  Eigen::Matrix3d axes;   ///< columns: unit vectors
  int dimension;          ///< number of extents above 1e-11 of the largest
};

/// A rotation about an axis: x goes to c + (x - c) R^T, where R turns by `angle` about `axis`.
struct AxisRotation
{
  Eigen::RowVector3d center = Eigen::RowVector3d::Zero(); ///< a point of the axis
  Eigen::RowVector3d axis = Eigen::RowVector3d::UnitZ();  ///< of length 1
  double angle = 0; ///< radians, in (0, pi], by the right-hand rule about `axis`

  /// Returns axis x (x - c): the displacement at a factor `s` of the angle is sin(s angle) times
  /// this, plus (1 - cos(s angle)) times second(x).
  Eigen::RowVector3d first(const Eigen::RowVector3d& x) const
  {
    return this->axis.cross(x - this->center);
  }
  /// Returns axis x (axis x (x - c)).
  Eigen::RowVector3d second(const Eigen::RowVector3d& x) const
  {
    return this->axis.cross(this->first(x));
  }
};

/// Returns the rotation that takes each row of `from` to that of `to`, within `tolerance`; both
/// #points x 3, `tolerance` in their unit. Throws Error where there is none: fewer than three
/// points or all on a line, a motion that changes distances, one without rotation, or one that also
/// slides along the axis. The message begins with the motion's fault ("The motion ..."). Cost: one
/// pass. Source: Kabsch, Acta Cryst. A32 (1976) 922-923.
AxisRotation fitRotation(const Points& from, const Points& to, double tolerance);
}
