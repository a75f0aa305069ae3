// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Interpolation/WeightMatrix.h"
#include "Support/Monitor.h"
#include "Support/Types.h"

#include <vector>

namespace morph
{
/// Interpolates residuals by compact kernels, without a system to solve. Site i has Wendland's C2
/// kernel with radius r_i, its distance from the nearest site before it. So its kernel vanishes at
/// all sites before it, and coefficients follow one after the other: a sparse triangular matrix.
///
/// Source: L. Kedward, C. B. Allen, T. C. S. Rendall, "Efficient and exact mesh deformation using
/// multiscale RBF interpolation", Journal of Computational Physics 345 (2017) 732-751; H. Wendland,
/// "Piecewise polynomial, positive definite and compactly supported radial functions of minimal
/// degree", Advances in Computational Mathematics 4 (1995) 389-396.
class CompactCorrection
{
public:
  /// `sites`, #sites x 3, and `radii`, of each: in farthest-point order (FarthestPoints.h), without
  /// the sites that need no correction. `targets`: #targets x 3. Cost and memory: 12 bytes a pair
  /// of a kernel and a target or later site in it, and searches in a k-d tree.
  void prepare(
    const Points& sites, const std::vector<double>& radii, const Points& targets, Monitor& monitor);

  Index numberOfSites() const { return this->atSites_.columns(); }
  /// Turns residuals, #sites x 3, into the kernels' coefficients, in place.
  void solve(Points& residuals) const;
  /// The adjoint of solve(), in place.
  void solveTranspose(Points& coefficients) const;
  /// #targets x #sites: the kernels at the targets.
  const WeightMatrix& atTargets() const { return this->atTargets_; }
  /// Returns the bytes in use.
  std::size_t memory() const { return this->atSites_.memory() + this->atTargets_.memory(); }

private:
  WeightMatrix atSites_; ///< #sites x #sites, strictly lower: the kernels at later sites
  WeightMatrix atTargets_;
};
}
