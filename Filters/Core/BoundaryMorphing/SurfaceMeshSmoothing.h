// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMorphing/BoundaryProjection.h"

#include <vector>

namespace morph
{
/// The result of smoothSurfaceMeshes().
struct SurfaceMeshSmoothing
{
  std::vector<Index> smoothed; ///< numbers of the surfaces whose nodes moved, ascending
  /// numbers of the surfaces that stay as they were, as smoothing found nothing better, ascending
  std::vector<Index> kept;
  Index steps = 0;       ///< of Newton's method
  Index evaluations = 0; ///< of an energy
  Index takenBack = 0;   ///< nodes that returned to the start, around faces that fell below it
};

SurfaceMeshSmoothing smoothSurfaceMeshes(const BoundaryFaces& faces, const Classification& geometry,
  const ProjectionTarget* target, BoundaryMotion& motion, Monitor& monitor);
}
