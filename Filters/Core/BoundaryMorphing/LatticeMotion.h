// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Monitor.h"
#include "Support/Types.h"

#include <array>
#include <vector>

namespace morph
{
/// A box of control points, whose displacements are spread over the box by a tensor product of
/// polynomials, or of B-splines. What is outside of the box has the displacement 0.
///
/// Each basis is that of B-splines with uniform clamped knots: of degree l - 1 for l control
/// points, which are Bernstein's polynomials, or of degree 3, or l - 1 where that is less. The
/// undeformed control points are at the Greville abscissae, so an affine motion of all of them is
/// one of the whole box.
///
/// Source: T. W. Sederberg, S. R. Parry, "Free-form deformation of solid geometric models",
/// SIGGRAPH 1986, 151-160 (Bernstein). L. Piegl, W. Tiller, "The NURBS Book", 2nd ed., Springer
/// 1997, algorithm A2.2 (B-splines).
struct LatticeMotion
{
  enum class Basis
  {
    Bernstein,
    BSpline
  };

  Basis basis = Basis::Bernstein;
  std::array<int, 3> size = { 3, 3, 3 }; ///< control points a direction, each in [2, 30]
  /// The box is [low, high] along its own axes, unit vectors as columns, from an origin.
  ///@{
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  Eigen::RowVector3d origin = Eigen::RowVector3d::Zero();
  Eigen::RowVector3d low = Eigen::RowVector3d::Zero(), high = Eigen::RowVector3d::Ones();
  ///@}
  /// Of the control points, those of the first direction first: #points x 3.
  Points controlDisplacements;

  /// Makes the box the bounding box of `places`, #places x 3, at least one. `along`: their
  /// principal axes, the longest first; else those of the coordinates. Cost: a pass over them.
  void surround(const Points& places, bool along);
  /// The undeformed control points, in the order of their displacements.
  Points controlPoints() const;
  /// The displacements at `places`, #places x 3. In a direction in which the box is flat, places
  /// have those of the first control points. Cost: one multiplication and addition a place and
  /// control point that moves it.
  Points displacements(const Points& places, Monitor& monitor) const;

private:
  int degree(int direction) const;
};
}
