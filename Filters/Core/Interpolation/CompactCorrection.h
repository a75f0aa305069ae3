// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Interpolation/WeightMatrix.h"
#include "Support/Monitor.h"
#include "Support/Types.h"

#include <memory>
#include <vector>

namespace morph
{
/// Interpolates residuals by compact kernels of ever smaller radius. Sites are in farthest-point
/// order, so the first n of them cover all evenly. A level has the sites up to some number, and
/// Wendland's C2 kernel, whose radius is 2.5 times their distance. It interpolates what the levels
/// before have left, at all its sites. The last level has all sites: the sum is exact there.
///
/// Source: M. S. Floater, A. Iske, "Multistep scattered data interpolation using compactly
/// supported radial basis functions", Journal of Computational and Applied Mathematics 73 (1996)
/// 65-78; H. Wendland, "Piecewise polynomial, positive definite and compactly supported radial
/// functions of minimal degree", Advances in Computational Mathematics 4 (1995) 389-396.
class CompactCorrection
{
public:
  CompactCorrection();
  ~CompactCorrection();
  CompactCorrection(CompactCorrection&&) noexcept;
  CompactCorrection& operator=(CompactCorrection&&) noexcept;

  /// `sites`, #sites x 3, and `distances`, of each: in farthest-point order (FarthestPoints.h). The
  /// first `exact` have no residual. `targets`: #targets x 3. Cost and memory: some 20 neighbors of
  /// a site and target a level.
  void prepare(const Points& sites, const std::vector<double>& distances, Index exact,
    const Points& targets, Monitor& monitor);

  /// Returns the levels; 0 without residuals.
  Index numberOfLevels() const;
  /// Adds the interpolant to `values`, #targets x 3. `residuals`: #sites x 3; of the first `exact`
  /// it takes 0 for granted. Cost: some 50 products with the kernels at the sites a level.
  void addTo(Points& values, Points residuals, Monitor& monitor) const;
  /// The adjoint of addTo(): returns #sites x 3, of the first `exact` 0. `gradient`: #targets x 3.
  Points transposed(const Points& gradient, Monitor& monitor) const;

private:
  struct Level;
  Index sites_ = 0, exact_ = 0;
  std::vector<std::unique_ptr<Level>> levels_;
};
}
