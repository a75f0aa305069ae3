// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

namespace morph
{
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
}
