// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

#include <vector>

namespace morph
{
/// The affine displacement field u(x) = u_c + (x - c) G nearest to given displacements in the sense
/// of least squares, of minimum norm where the points lie in a plane, on a line or in one point.
/// Zero for zero displacements, and linear in them. Cost: one pass.
class AffineFit
{
public:
  /// `rest`: all nodes; `ids`: those with a displacement; `displacement`: #ids x 3.
  AffineFit(const Points& rest, const std::vector<Index>& ids, const Points& displacement);
  /// From sums over the points x with displacements d: c their mean position, m their mean
  /// displacement, `spread` the sum of (x - c)^T (x - c) and `stretch` that of (x - c)^T (d - m).
  AffineFit(const Eigen::RowVector3d& centre, const Eigen::RowVector3d& mean,
    const Eigen::Matrix3d& spread, const Eigen::Matrix3d& stretch);

  template <typename Row>
  Eigen::RowVector3d displacement(const Row& x) const
  {
    return this->mean_ + (x - this->centre_) * this->gradient_;
  }

  /// G, 3 x 3: positions, as rows, are multiplied by I + G.
  const Eigen::Matrix3d& gradient() const { return this->gradient_; }

private:
  friend class AffineLeastSquares;
  AffineFit() = default;

  Eigen::RowVector3d centre_, mean_;
  Eigen::Matrix3d gradient_;
};

/// What is the same for all displacements of one set of points: the fit as a fixed matrix, and its
/// adjoint.
class AffineLeastSquares
{
public:
  AffineLeastSquares() = default;
  /// `rest`: #points x 3, copied; without points every fit is zero. Directions in which the points
  /// extend less than 1e-5 of their largest extent (root mean square) count as flat: the fit's
  /// gradient vanishes along them.
  explicit AffineLeastSquares(const Points& rest);

  /// Whether points with this second moment along an axis, and `largest` along another, count as
  /// extended there: a ratio of 1e-5 in extent.
  static bool isExtended(double moment, double largest) { return moment > 1e-10 * largest; }

  /// 3 for points in space, 2 in a plane, 1 on a line, 0 in one place.
  int rank() const { return this->rank_; }

  /// `displacement`: #points x 3.
  AffineFit fit(const Points& displacement) const;

  /// The adjoint of displacement -> sum over rows i of gradient_i . fit(displacement)(x_i), for the
  /// places `x` (#x x 3) and gradients `gradient` (#x x 3): adds to `displacement` (#points x 3).
  /// Cost: one pass over each.
  void fitTranspose(const Points& x, const Points& gradient, Points& displacement) const;

private:
  Points arms_; ///< rest - centre
  Eigen::RowVector3d centre_ = Eigen::RowVector3d::Zero();
  /// pseudo-inverse of the arms' second moments
  Eigen::Matrix3d inverse_ = Eigen::Matrix3d::Zero();
  int rank_ = 0;
};
}
