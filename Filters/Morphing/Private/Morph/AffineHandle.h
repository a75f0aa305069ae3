// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Morpher/AffineModes.h"
#include "Private/Morph/BoundaryMatch.h"

#include <optional>

class vtkPointSet;

namespace morph::filters
{
/// A boundary's own description of its motion, for the nodes that it was matched to.
struct AffineHandle
{
  morph::AffineFields Fields; ///< #Ids x 4
  morph::AffineMotion Motion;

  /// The one of `boundary`, or nothing unless it has AffineArrays that take the nodes to their
  /// targets, up to rounding. So arrays do no harm that a filter in between has made stale.
  /// `match`: of `boundary`. `scale`: what multiplies its motion. `isFloat`: the result is rounded
  /// to single precision, so that the boundary may be. Cost: one pass over the boundary.
  static std::optional<AffineHandle> Of(vtkPointSet* boundary, const BoundaryMatch::Result& match,
    const morph::Mesh& rest, double scale, bool isFloat);
};
}
