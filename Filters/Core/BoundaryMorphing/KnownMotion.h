// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMorphing/MotionFit.h"

#include <map>
#include <optional>
#include <vector>

namespace morph
{
/// The known displacements of a boundary, summed at most once by surface and by body, when they are
/// asked for. Curves and surfaces fit affine or rigid fields to these sums.
class KnownMotion
{
public:
  /// Keeps references to both; `motion` must not change while the object is in use. Cost: a look at
  /// the surfaces' nodes.
  KnownMotion(const Classification& geometry, const BoundaryMotion& motion);

  /// Returns the motion of the first set whose affine span (line, plane, space) contains the curve,
  /// or of the last nonempty one. The sets are the known nodes of the curve, of its adjacent
  /// surfaces, of its body: none where a body has no known node. An affine motion of the set is
  /// then known on the curve. Where a set is nearly flat and the curve leaves it, the set tells a
  /// share, and the next ones the rest (PrincipalDirections). Cost: the curve's nodes; once for
  /// each set of adjacent surfaces, the nodes of all but the largest.
  MotionAround around(const GeometryCurve& curve);
  /// The same for other nodes on a body. Cost: `nodes`.
  MotionAround around(Index body, const std::vector<Index>& nodes);

  /// Returns the number of known nodes summed so far, a measure of the cost.
  Index summed() const { return this->summed_; }

private:
  MotionSums sumOf(const std::vector<Index>& ids);
  const MotionSums& ofSurface(Index surface);
  /// Sums by body, unless that is done.
  void sumBodies();
  const MotionSums& besides(const GeometryCurve& curve);
  void add(const MotionSums& sums, const Points& places, MotionAround& around) const;
  void addBody(Index body, const Points& places, MotionAround& around);

  const BoundaryMotion& motion_;
  /// maximum distance of a node from an affine span that contains it
  double tolerance_ = 0;
  std::vector<std::vector<Index>> ofSurface_;      ///< #surfaces: the known nodes
  std::vector<std::optional<MotionSums>> surface_; ///< #surfaces
  /// one more than #bodies; the first has the nodes of no body; empty where not summed
  std::vector<MotionSums> body_;
  std::map<std::vector<Index>, MotionSums> besides_; ///< by the adjacent surfaces of a curve
  Index summed_ = 0;
};
}
