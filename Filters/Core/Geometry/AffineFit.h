// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

namespace morph
{
/// The affine displacement field u(x) = u_c + (x - c) G that fits given displacements by least
/// squares. G has minimum norm where the points lie in a plane, on a line or in one point. The fit
/// is linear in the displacements. Cost: one pass.
class AffineFit
{
public:
  /// Builds the fit from sums over points x with displacements d. `centre`, c: their mean position;
  /// `mean`, m: their mean displacement; `spread`: sum of (x - c)^T (x - c); `stretch`: sum of (x -
  /// c)^T (d - m).
  AffineFit(const Eigen::RowVector3d& centre, const Eigen::RowVector3d& mean,
    const Eigen::Matrix3d& spread, const Eigen::Matrix3d& stretch);

  template <typename Row>
  Eigen::RowVector3d displacement(const Row& x) const
  {
    return this->mean_ + (x - this->centre_) * this->gradient_;
  }

  /// Returns G, 3 x 3: a position, as a row vector, is multiplied by I + G.
  const Eigen::Matrix3d& gradient() const { return this->gradient_; }

private:
  friend class AffineLeastSquares;
  AffineFit() = default;

  Eigen::RowVector3d centre_, mean_;
  Eigen::Matrix3d gradient_;
};

/// The affine fit for many displacements of one point set, as a fixed matrix, and its adjoint.
class AffineLeastSquares
{
public:
  AffineLeastSquares() = default;
  /// `rest`: undeformed points, #points x 3, copied. Without points every fit is zero. A direction
  /// is flat where the points' root mean square extent is below 1e-5 of the largest. The fit's
  /// gradient vanishes along flat directions.
  explicit AffineLeastSquares(const Points& rest);

  /// Whether the second moment `moment` exceeds 1e-10 of `largest`, a ratio of 1e-5 in extent.
  static bool isExtended(double moment, double largest) { return moment > 1e-10 * largest; }

  /// The dimension the points span: 3 in space, 2 in a plane, 1 on a line, 0 in one point.
  int rank() const { return this->rank_; }

  /// `displacement`: #points x 3.
  AffineFit fit(const Points& displacement) const;

  /// The adjoint of fit(): differentiates the sum of gradient_i . fit(displacement)(x_i) over rows
  /// i. `x`, `gradient`: #x x 3. Adds the derivative to `displacement`, #points x 3. Cost: one pass
  /// over each.
  void fitTranspose(const Points& x, const Points& gradient, Points& displacement) const;

private:
  Points arms_; ///< undeformed points relative to centre_
  Eigen::RowVector3d centre_ = Eigen::RowVector3d::Zero();
  /// pseudo-inverse of the arms' second moments
  Eigen::Matrix3d inverse_ = Eigen::Matrix3d::Zero();
  int rank_ = 0;
};
}
