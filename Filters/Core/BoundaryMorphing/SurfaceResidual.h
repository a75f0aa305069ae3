// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Geometry/AffineFit.h"
#include "Interpolation/InterpolationSites.h"
#include "Interpolation/WeightMatrix.h"
#include "Support/Monitor.h"

#include <vector>

namespace morph
{
/// The weighted residual on one surface: its points follow prescribed points, usually those of its
/// curves. It uses equations (3) to (6) of Staten et al. (IMR 2011), as WeightedResidual does for
/// volumes. In addition, prescribed points in a plane do not determine the affine map across it,
/// which would flatten a dome. There the normal is mapped to the normal of the best-fit plane of
/// the moved points. It is scaled by the square root of the ratio of areas. X. Roca and J. Sarrate,
/// "Least-squares approximation of affine mappings for sweep mesh generation", show why the plain
/// functional fails. Where the points are nearly in a plane, both maps count by the shares of
/// PrincipalDirections.
///
/// The result is not linear in the prescribed positions, so there is no adjoint.
class SurfaceResidual
{
public:
  /// Closed chains of prescribed points (row numbers), oriented as the boundary of an oriented
  /// surface: the outer one counter-clockwise around the normal, holes clockwise, or all reversed.
  using Loops = std::vector<std::vector<Index>>;

  /// Sets the number of prescribed points that influence a point (or all of fewer). At least 1,
  /// default 20, the paper's choice for surfaces.
  void setNumberOfNeighbors(Index count);
  Index numberOfNeighbors() const { return this->numberOfNeighbors_; }

  /// `prescribed`: #prescribed x 3 and `points`: #points x 3, undeformed positions; coincident
  /// prescribed points count once. With loops, their vector area determines the orientation and
  /// area of the moved plane. Without loops (empty), the affine map does. Throws Error for
  /// positions that are not finite, loops of fewer than three points or with rows that do not
  /// exist, and without prescribed points. Cost: as inverseDistanceWeights().
  void prepare(
    const Points& prescribed, const Points& points, const Loops& loops, Monitor& monitor);

  /// `prescribed`: #prescribed x 3, new positions. `moved`: becomes #points x 3, the undeformed
  /// positions bit for bit without motion. May be called any number of times. Returns whether the
  /// affine map reflects or flattens, so that the best rotation and scale take its place. Throws
  /// Error, leaving `moved` untouched, for a wrong number of rows, positions that are not finite,
  /// or unless the last prepare() succeeded. Cost: one pass over the weights.
  bool evaluate(const Points& prescribed, Points& moved, Monitor& monitor) const;

  /// The part of evaluate() that is linear in the displacements, and the same for each coordinate:
  /// neither maps the normal nor replaces a map. It is evaluate() where the surface is plane, or
  /// its prescribed points are not, as long as the map neither reflects nor flattens.
  /// `displacement`: #prescribed x 3; `moved`: becomes the displacements of the points, #points x
  /// 3. Throws Error, and costs, as evaluate() does.
  void evaluateLinear(const Points& displacement, Points& moved, Monitor& monitor) const;

private:
  struct Map;
  Map linearMap(const Points& displacement) const;
  Map map(const Points& displacement, const Points& prescribed) const;
  /// Throws Error unless prepare() succeeded for so many rows, all finite.
  void require(const Points& prescribed) const;
  /// The displacements of the points, where `residual` are those of the sites.
  Points spread(const Map& map, Points residual, Monitor& monitor) const;

  Index numberOfNeighbors_ = 20;
  bool prepared_ = false;
  Points prescribed_, points_;
  Loops loops_;
  InterpolationSites sites_;
  AffineLeastSquares fit_;
  WeightMatrix weights_;
};
}
