// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMorphing/MotionFit.h"

#include <map>
#include <vector>

namespace morph
{
/// The known displacements of a boundary at one moment, summed once by surface and by body, for all
/// the curves and surfaces that take an affine or rigid field from what moves around them.
class KnownMotion
{
public:
  /// Keeps references to both: `motion` must not change while this is asked. Cost: one pass over
  /// the surfaces' nodes.
  KnownMotion(const Classification& geometry, const BoundaryMotion& motion);

  /// The known nodes on the curve, or on the surfaces beside it, on its body, or all: the first of
  /// these sets whose flat (line, plane, space) holds the curve, so that an affine motion of the
  /// set is known on the curve. The last that is not empty if none does. Cost: the curve's nodes
  /// and those of its surfaces but the largest, once for each such set of surfaces.
  MotionSums around(const GeometryCurve& curve);
  /// The same for other nodes on a body: its known nodes, or all. Cost: `nodes`.
  MotionSums around(Index body, const std::vector<Index>& nodes) const;

  /// Known nodes that were summed so far: a measure of the cost.
  Index summed() const { return this->summed_; }

private:
  MotionSums sumOf(const std::vector<Index>& ids);
  const MotionSums& besides(const GeometryCurve& curve);
  bool holds(const MotionSums& sums, const std::vector<Index>& nodes) const;

  const BoundaryMotion& motion_;
  double tolerance_ = 0;                      ///< length below which a node lies in a flat
  std::vector<std::vector<Index>> ofSurface_; ///< #surfaces: the known nodes
  std::vector<MotionSums> surface_;           ///< #surfaces
  std::vector<MotionSums> body_; ///< one more than #bodies, the first of the nodes on none
  MotionSums all_;
  std::map<std::vector<Index>, MotionSums> besides_; ///< by the surfaces beside a curve
  Index summed_ = 0;
};
}
