// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Communicator.h"
#include "Support/Types.h"

namespace morph
{
/// The principal directions of points, and how much of a gradient along each their displacements
/// tell. Let x_k be the coordinates of a place about the points' center along the directions k, and
/// s_k the root mean square of the points' own. A gradient along j moves the place by x_j / s_j
/// times the largest displacement of the points at most. Where the points are nearly flat, that is
/// a motion of their unevenness multiplied out. The place's leverage in j bounds it:
///
///     l_j(x)^2 = sum over k of (x_k / s_k)^2 min(1, s_k / s_j)^4.
///
/// It does not depend on the choice of directions with the same extent. If l_j exceeds that of the
/// points by no more than 8, the direction counts whole. So all do between the points. Beyond, its
/// share falls with the square of the excess. The motion by a gradient then vanishes as the points
/// become flat, continuously.
class PrincipalDirections
{
public:
  /// `spread`: the sum of (x - c)^T (x - c) over `count` points about their mean position c.
  PrincipalDirections(const Eigen::Matrix3d& spread, double count);

  /// Measures the extents along the directions: small ones lose digits in the spread's squares.
  /// `arms`: of the points, from their mean position; each process of `all` has some. Before
  /// limit().
  void measure(const Points& arms, const Communicator& all);

  /// Unit vectors, by ascending extent, as columns.
  const Eigen::Matrix3d& axes() const { return this->axes_; }
  /// The leverages of a place at `arm` from the center.
  Eigen::RowVector3d leverages(const Eigen::RowVector3d& arm) const;
  /// Sets the shares. `within`: the largest leverages of the points; 1, their root mean square,
  /// where they are not known. `reach`: those of the places. Without it the places are the points.
  void limit(const Eigen::RowVector3d& within, const Eigen::RowVector3d& reach);

  /// The part of a gradient along each direction that counts, in [0, 1].
  const Eigen::RowVector3d& shares() const { return this->shares_; }
  /// The dimension that the points span, where directions count with an extent above 1e-5 of the
  /// largest: 3 in space, 2 in a plane, 1 on a line, 0 in one point.
  int rank() const;
  /// The pseudo-inverse of the spread, each direction by its share.
  Eigen::Matrix3d inverse() const;
  /// The rest: the identity less the shares. Another gradient, multiplied by it, completes a fit.
  Eigen::Matrix3d rest() const;

private:
  double count_;
  Eigen::Matrix3d axes_;
  Eigen::RowVector3d extent_, shares_;
};

/// The affine displacement field u(x) = u_c + (x - c) G that fits given displacements by least
/// squares. G has minimum norm where the points lie in a plane, on a line or in one point, and
/// where they are nearly flat its directions count by their shares. The fit is linear in the
/// displacements. Cost: one pass.
class AffineFit
{
public:
  /// No motion.
  AffineFit() = default;
  /// Builds the fit from sums over points x with displacements d. `center`, c: their mean position;
  /// `mean`, m: their mean displacement; `inverse`: of their principal directions; `stretch`: sum
  /// of (x - c)^T (d - m).
  AffineFit(const Eigen::RowVector3d& center, const Eigen::RowVector3d& mean,
    const Eigen::Matrix3d& inverse, const Eigen::Matrix3d& stretch)
    : center_(center)
    , mean_(mean)
    , gradient_(inverse * stretch)
  {
  }

  template <typename Row>
  Eigen::RowVector3d displacement(const Row& x) const
  {
    return this->mean_ + (x - this->center_) * this->gradient_;
  }

  /// Returns G, 3 x 3: a position, as a row vector, is multiplied by I + G.
  const Eigen::Matrix3d& gradient() const { return this->gradient_; }

private:
  Eigen::RowVector3d center_ = Eigen::RowVector3d::Zero(), mean_ = Eigen::RowVector3d::Zero();
  Eigen::Matrix3d gradient_ = Eigen::Matrix3d::Zero();
};

/// The affine fit for many displacements of one point set, as a fixed matrix, and its adjoint. The
/// points may be on several processes, `all`, each point on one. Then all functions are collective
/// but directions() and weights(). The fit is the same on all processes, and points and places are
/// those of one. Messages: 500 bytes in all, 100 for a fit.
class AffineLeastSquares
{
public:
  AffineLeastSquares()
    : AffineLeastSquares(Points(0, 3))
  {
  }
  /// `rest`: undeformed points, #points x 3, copied. Without points every fit is zero. `places`:
  /// #places x 3, those that the fit moves; without them it moves the points.
  explicit AffineLeastSquares(const Points& rest, const ConstPoints& places = Points(0, 3),
    const Communicator& all = Communicator::alone());

  const PrincipalDirections& directions() const { return this->directions_; }

  /// `displacement`: #points x 3.
  AffineFit fit(const Points& displacement, const Communicator& all = Communicator::alone()) const;

  /// The part of each point's displacement in that of `place`. They sum to 1. On one process.
  Eigen::VectorXd weights(const Eigen::RowVector3d& place) const;

  /// The adjoint of fit(): differentiates the sum of gradient_i . fit(displacement)(x_i) over rows
  /// i. `x`, `gradient`: #x x 3. Adds the derivative to `displacement`, #points x 3. Cost: one pass
  /// over each.
  void fitTranspose(const Points& x, const Points& gradient, Points& displacement,
    const Communicator& all = Communicator::alone()) const;

private:
  Points arms_;      ///< undeformed points relative to center_
  double count_ = 0; ///< of the points of all processes
  Eigen::RowVector3d center_ = Eigen::RowVector3d::Zero();
  PrincipalDirections directions_{ Eigen::Matrix3d::Zero(), 0 };
  Eigen::Matrix3d inverse_ = Eigen::Matrix3d::Zero(); ///< of directions_
};
}
