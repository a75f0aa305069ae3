// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <optional>

namespace morph
{
/// The sign of det [b - a, c - a, d - a]: 1 where the tetrahedron a, b, c, d is positive in VTK's
/// order, 0 where it is flat, -1. It is the sign for the coordinates as given, not for rounded
/// differences: a determinant clear of its own rounding error decides, else all its products are
/// summed without rounding as an expansion (J. R. Shewchuk, "Adaptive precision floating-point
/// arithmetic and fast robust geometric predicates", Discrete Comput. Geom. 18 (1997) 305-363,
/// theorem 10). No value for coordinates that are not finite, and where the exact sum is needed but
/// the coordinates span more than 2^600, so that its products would underflow.
/// Cost: 0.1 microseconds, or 5 for nearly flat tetrahedra.
std::optional<int> orientationSign(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
  const Eigen::Vector3d& c, const Eigen::Vector3d& d);

/// The power of two that brings the largest of the coordinates to [2^299, 2^300), where products of
/// three neither overflow nor (unless they are smaller than 2^-600 of the largest) underflow; 1
/// where all are 0 or one is not finite. Scaling by it is exact but for coordinates that are
/// smaller still.
double exactScale(const Eigen::Vector3d* points, int count);
}
