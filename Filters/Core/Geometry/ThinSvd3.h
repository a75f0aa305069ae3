// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

namespace morph
{
/// Singular values and right singular vectors of a set of vectors, largest first. From an
/// orthogonal factorisation, which keeps the digits that the sum of their squares would lose:
/// extents down to 1e-15 of the largest are meant.
struct ThinSvd3
{
  /// `vectors`: k x 3, finite.
  explicit ThinSvd3(const ConstPoints& vectors);

  Eigen::Vector3d extent; ///< singular values
  Eigen::Matrix3d axes;   ///< columns: unit vectors
  int dimension;          ///< extents that exceed 1e-11 of the largest
};
}
