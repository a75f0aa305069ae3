// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

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
}
