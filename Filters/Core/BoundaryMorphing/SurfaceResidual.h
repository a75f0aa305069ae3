// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Geometry/AffineFit.h"
#include "Interpolation/InterpolationSites.h"
#include "Interpolation/WeightMatrix.h"
#include "Support/Monitor.h"

#include <vector>

namespace morph
{
/// Weighted residuals on one surface: its points follow the motion of prescribed points, as a rule
/// those of the curves round it. Equations (3) to (6) of Staten et al. (IMR 2011), as
/// WeightedResidual has them for volumes, with what surfaces need: prescribed points in a plane
/// leave the affine map unknown across it, which would flatten a dome, so there the normal is
/// carried over to the normal of the moved points' best-fit plane, scaled by the root of the ratio
/// of areas. X. Roca and J. Sarrate, "Least-squares approximation of affine mappings for sweep mesh
/// generation", show how the plain functional fails without such a term.
///
/// The result is not linear in the prescribed positions, so there is no adjoint.
class SurfaceResidual
{
public:
  /// Closed chains of prescribed points (row numbers), oriented as the boundary of an oriented
  /// surface: the outer one counter-clockwise round the normal, holes clockwise, or all reversed.
  using Loops = std::vector<std::vector<Index>>;

  enum class Fit
  {
    Affine,      ///< prescribed points in space
    Plane,       ///< prescribed points in a plane: affine in the plane, the normal carried over
    Translation, ///< prescribed points on a line or at one place
    Similarity   ///< instead of a map that reflects or flattens: best rotation and a scale
  };

  struct Report
  {
    Fit fit = Fit::Affine;
    /// Of the affine map before any replacement; zero or negative where it was replaced.
    double determinant = 1;
    bool replaced() const { return this->fit == Fit::Similarity; }
  };

  /// How many prescribed points take part at a point (all of them where there are fewer). At least
  /// 1, default 20, the paper's choice for surfaces.
  void setNumberOfNeighbors(Index count);
  Index numberOfNeighbors() const { return this->numberOfNeighbors_; }

  /// `prescribed`: #prescribed x 3 and `points`: #points x 3, rest positions; coincident prescribed
  /// points count once. `loops` may be empty: then the moved plane faces where the affine map turns
  /// it, and areas are those of the map. With loops, their vector area decides both. Throws Error
  /// for positions that are not finite, loops of fewer than three points or with rows that do not
  /// exist, and where nothing is prescribed. Cost: as inverseDistanceWeights.
  void prepare(
    const Points& prescribed, const Points& points, const Loops& loops, Monitor& monitor);

  /// `prescribed`: #prescribed x 3, new positions. `moved`: becomes #points x 3; the rest positions
  /// bit for bit where nothing moves. May be called any number of times. Throws Error, leaving
  /// `moved` untouched, for a wrong number of rows, positions that are not finite, or where no
  /// prepare() has succeeded last. Cost: one pass over the weights.
  Report evaluate(const Points& prescribed, Points& moved, Monitor& monitor) const;

private:
  struct Map;
  Map map(const Points& displacement, const Points& prescribed) const;

  Index numberOfNeighbors_ = 20;
  bool prepared_ = false;
  Points prescribed_, points_;
  Loops loops_;
  InterpolationSites sites_;
  AffineLeastSquares fit_;
  WeightMatrix weights_;
};
}
