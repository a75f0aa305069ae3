// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/Classification.h"
#include "BoundaryMorphing/BoundaryMotion.h"
#include "BoundaryMorphing/SurfaceResidual.h"
#include "Support/Monitor.h"

#include <vector>

namespace morph
{
struct SurfaceMorphOptions
{
  enum class Method : std::uint8_t
  {
    WeightedResidual, ///< the paper's choice: SurfaceResidual.h
    HarmonicExtension ///< SurfaceHarmonicExtension.h
  };
  Method method = Method::WeightedResidual;
  Index neighbors = 20; ///< of the weighted residual, at least 1
  UnattachedMotion unattached = UnattachedMotion::FollowAffinely;
};

struct SurfaceMorphReport
{
  /// surfaces whose affine map reflects or flattens them; they took the nearest similarity
  std::vector<Index> reflected;
  std::vector<Index> unattached; ///< surfaces on which nothing is known; they moved by `unattached`
};

/// The weights of the weighted residual, kept between calls of morphSurfaces() with one undeformed
/// mesh, one classification and one number of neighbors, where displacements alone change: a
/// surface's are used again as long as the same of its nodes are fixed. Clear it, by assigning an
/// empty one, where any of the others changes.
struct SurfaceWeights
{
  struct Surface
  {
    std::vector<Index> fixed; ///< that `residual` is prepared for; empty: for none
    SurfaceResidual residual;
  };
  std::vector<Surface> surfaces; ///< #surfaces, or none yet
  Index prepared = 0;            ///< how many surfaces' weights were made so far
};

/// Moves the nodes of all surfaces that are not known yet: each surface by itself, its curves' and
/// vertices' nodes fixed, and those given on it. To be called after morphCurves(). A surface on
/// which nothing is known (a closed one, without curves) follows the known nodes of its body, or of
/// all bodies, by options.unattached. Where nothing moves around a surface, it stays, exactly.
/// `kept`: see there; the result is the same with and without, and null is without. Throws Error as
/// SurfaceResidual does. Cost: that of the method on each surface.
SurfaceMorphReport morphSurfaces(const BoundaryFaces& faces, const Classification& geometry,
  const SurfaceMorphOptions& options, BoundaryMotion& motion, Monitor& monitor,
  SurfaceWeights* kept = nullptr);
}
