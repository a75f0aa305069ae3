// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Interpolation/InterpolationSites.h"
#include "Interpolation/WeightMatrix.h"
#include "Mesh/Mesh.h"
#include "Support/Monitor.h"

#include <vector>

namespace morph
{
/// A displacement that decreases with the distance from the moving nodes. A place x at distance d
/// from the nearest of them moves by
///
///   u(x) = f(d / R) sum_k w_k(x) U_k,   f(t) = (1 - t)^4 (4 t + 1) for t < 1 and 0 beyond.
///
/// R is the radius and U_k are the displacements of the 20 nearest moving nodes. w_k are their
/// inverse distance weights (inverseDistanceWeights()). f is twice continuously differentiable, and
/// 1 at 0. Source: H. Wendland, "Piecewise polynomial, positive definite and compactly supported
/// radial functions of minimal degree", Adv. Comput. Math. 4 (1995) 389-396.
class Falloff
{
public:
  /// `moving`: #moving x 3, at least one, undeformed; `places`: #places x 3, undeformed; `radius`:
  /// R, positive and finite, in the unit of the points. Throws Error for other radii and without a
  /// moving node. Cost: two nearest-node searches, for all places and for the places within the
  /// radius.
  void prepare(const Points& moving, const Points& places, double radius, Monitor& monitor);

  /// `displacement`: #moving x 3. Returns #places x 3, exactly zero at the radius and beyond. Cost:
  /// one pass over the weights.
  Points evaluate(const Points& displacement, Monitor& monitor) const;

  /// Returns the rows of `places` within the radius, ascending.
  const std::vector<Index>& reached() const { return this->reached_; }

private:
  Index places_ = 0;
  InterpolationSites sites_;
  std::vector<Index> reached_;
  std::vector<double> factor_; ///< #reached, f
  WeightMatrix weights_;       ///< #reached x #sites
};
}
