// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Geometry/AffineFit.h"
#include "Interpolation/RadialKernel.h"
#include "Support/Monitor.h"
#include "Support/Types.h"

#include <vector>

namespace morph
{
/// A point with its displacement. A radius of 0 is no limit; a positive one ends its effect.
struct Handle
{
  Eigen::RowVector3d place = Eigen::RowVector3d::Zero();
  Eigen::RowVector3d displacement = Eigen::RowVector3d::Zero();
  double radius = 0;
};

/// The displacement field that takes given values at handles:
///
///     u(x) = sum over handles without radius of a_j r^2 log r + p(x)
///          + sum over handles with radius R_j of b_j (1 - q)_+^4 (4 q + 1),  q = r / R_j
///
/// with r = |x - c_j|, a linear polynomial p, and sum a_j q(c_j) = 0 for every linear polynomial q.
/// Handles without radius have the thin-plate spline: affine motions of four that are not nearly in
/// a plane come out affine. Of handles in a plane, on a line or of a single one, p varies within
/// their span alone, so that one handle translates everything. Where they are nearly flat, p varies
/// across them by the share of PrincipalDirections. Without such handles p is 0.
///
/// Source: H. Wendland, "Scattered Data Approximation", Cambridge University Press 2005, chapters 8
/// and 9.
class HandleMotion
{
public:
  static constexpr Index MostHandles = 2000;

  /// Throws Error for no handle, more than MostHandles, numbers that are not finite or beyond 1e50,
  /// and a negative radius. Throws it too for handles in the same place (1e-10 of their extent),
  /// and where rounding or overlapping radii leave no solution. Cost: n^3 2/3 multiplications and
  /// additions; 8 n^2 bytes.
  explicit HandleMotion(const std::vector<Handle>& handles);

  /// The displacements at `places`, #places x 3. Exactly 0 outside of all radii where each handle
  /// has one. Cost: one kernel a place and handle.
  Points displacements(const Points& places, Monitor& monitor) const;

private:
  struct Group ///< handles with one kernel
  {
    RadialKernel kernel;
    Points centers, strengths; ///< in units of size_ around center_
  };

  bool hasPolynomial_ = false;
  AffineFit trend_; ///< least squares over the handles without radius
  Eigen::RowVector3d center_;
  double size_ = 1;
  std::vector<Group> groups_;
  /// What p adds to the trend: 1 and three coordinates, in the units above.
  Eigen::Matrix<double, 4, 3> polynomial_ = Eigen::Matrix<double, 4, 3>::Zero();
};
}
