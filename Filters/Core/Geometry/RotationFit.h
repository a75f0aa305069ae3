// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

#include <Eigen/Geometry>

namespace morph
{
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
