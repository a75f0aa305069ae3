// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Geometry/AffineFit.h"
#include "Geometry/NearestNodes.h"
#include "Interpolation/RadialInterpolant.h"
#include "Support/Monitor.h"
#include "Support/Types.h"

#include <memory>
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
/// With a smoothing length h the field approximates instead. It is the affine fit of all handles
/// and the mean of their residuals, each with the weight (1 - q)_+^4 (4 q + 1), q = r / (h + d).
/// Here d is the distance of the nearest handle. So affine motions come out affine, noise below h
/// is averaged, and far from all handles the nearest ones count.
///
/// Source: H. Wendland, "Scattered Data Approximation", Cambridge University Press 2005, chapters 8
/// and 9. E. A. Nadaraya, Theory Probab. Appl. 9 (1964) 141-142, for the mean.
class HandleMotion
{
public:
  static constexpr Index MostHandles = 2000, MostSmoothed = 100000;

  /// `smoothing`: the length h, 0 for a field that meets the handles. Throws Error for no
  /// handle, more than MostHandles, or than MostSmoothed with h, numbers that are not finite or
  /// beyond 1e50, and a negative radius. Without h it throws it too for handles in the same
  /// place (1e-10 of their extent), and where rounding or overlapping radii leave no solution;
  /// with h, for a radius. Cost: n^3 2/3 multiplications and additions, 8 n^2 bytes; with h, a
  /// k-d tree.
  explicit HandleMotion(const std::vector<Handle>& handles, double smoothing = 0);

  /// The displacements at `places`, #places x 3. Exactly 0 outside of all radii where each handle
  /// has one. Cost: one kernel a place and handle; with h, a place and handle within h + d.
  Points displacements(const Points& places, Monitor& monitor) const;

private:
  struct Group ///< handles with one kernel
  {
    RadialKernel kernel;
    Points centers, strengths; ///< in units of size_ around center_
  };

  void smooth(const Points& places, Points values, double length);
  void interpolate(const std::vector<Handle>& handles, const Points& places, Points values);
  /// The mean of the residuals at a place.
  Eigen::RowVector3d residual(const Eigen::RowVector3d& place) const;

  double length_ = 0;                     ///< h
  std::unique_ptr<NearestNodes> handles_; ///< with h, else null
  Points places_, residuals_;             ///< of them
  bool hasPolynomial_ = false;
  AffineFit trend_; ///< least squares over the handles without radius
  Eigen::RowVector3d center_;
  double size_ = 1;
  std::vector<Group> groups_;
  /// What p adds to the trend: 1 and three coordinates, in the units above.
  Eigen::Matrix<double, 4, 3> polynomial_ = Eigen::Matrix<double, 4, 3>::Zero();
};
}
