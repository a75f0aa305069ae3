// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMotion.h"
#include "Classification.h"
#include "Monitor.h"

#include <vector>

namespace morph
{
struct SurfaceMorphOptions
{
  enum class Method : std::uint8_t
  {
    WeightedResidual, ///< the paper's choice: SurfaceResidual.h
    Smoothing         ///< SurfaceSmoothing.h
  };
  Method method = Method::WeightedResidual;
  Index neighbors = 20; ///< of the weighted residual, at least 1
  Unattached unattached = Unattached::FollowAffinely;
};

struct SurfaceMorphReport
{
  std::vector<Index>
    reflected; ///< surfaces whose affine map reflects or flattens them; they took the nearest similarity
  std::vector<Index> unattached; ///< surfaces on which nothing is known; they moved by `unattached`
};

/// Moves the nodes of all surfaces that are not known yet: each surface by itself, its curves' and vertices' nodes
/// fixed, and those given on it. To be called after morphCurves(). A surface on which nothing is known (a closed one,
/// without curves) follows the known nodes of its body, or of all bodies, by options.unattached. Where nothing moves
/// around a surface, it stays, exactly. Throws Error as SurfaceResidual does. Cost: that of the method on each
/// surface.
SurfaceMorphReport morphSurfaces(const BoundaryFaces& faces, const Classification& geometry,
  const SurfaceMorphOptions& options, BoundaryMotion& motion, Monitor& monitor);
}
