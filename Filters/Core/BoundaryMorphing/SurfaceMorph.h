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
    WeightedResidual,  ///< the paper's choice: SurfaceResidual.h
    HarmonicExtension, ///< SurfaceHarmonicExtension.h
    MeshSmoothing      ///< the same; then call smoothSurfaceMeshes()
  };
  Method method = Method::WeightedResidual;
  Index neighbors = 20; ///< number for the weighted residual, at least 1
  UnattachedMotion unattached = UnattachedMotion::FollowAffinely;
  /// Only the part of the weighted residual that is linear in the displacements, see
  /// SurfaceResidual::evaluateLinear(); `method` has no effect.
  bool linear = false;

  bool operator==(const SurfaceMorphOptions& other) const
  {
    return this->method == other.method && this->neighbors == other.neighbors &&
           this->unattached == other.unattached && this->linear == other.linear;
  }
};

struct SurfaceMorphReport
{
  /// surfaces whose affine map reflects or flattens them; they took the nearest similarity
  std::vector<Index> reflected;
  std::vector<Index> unattached; ///< surfaces without known nodes; they moved by `unattached`
};

/// The weights of the weighted residual, kept between calls of morphSurfaces(). They are valid for
/// one undeformed mesh, one classification and one number of neighbors. A surface's weights are
/// reused while the same of its nodes are fixed. Assign an empty object if anything else changes.
struct SurfaceWeights
{
  struct Surface
  {
    std::vector<Index> fixed; ///< the nodes that `residual` is prepared for; empty for none
    SurfaceResidual residual;
  };
  std::vector<Surface> surfaces; ///< #surfaces, or none yet
  Index prepared = 0;            ///< number of surfaces whose weights were computed
};

/// Moves the unknown nodes of all surfaces. Each surface moves by itself; nodes of its curves and
/// vertices, and given nodes on it, are fixed. Call it after morphCurves(). A surface without known
/// nodes (closed, without curves) follows the known nodes of its body by options.unattached, and
/// stays where there are none. A surface whose known nodes do not move stays exactly. `kept`:
/// reused weights, or null; the result is the same. Throws Error as SurfaceResidual does. Cost:
/// that of the method on each surface.
SurfaceMorphReport morphSurfaces(const BoundaryFaces& faces, const Classification& geometry,
  const SurfaceMorphOptions& options, BoundaryMotion& motion, Monitor& monitor,
  SurfaceWeights* kept = nullptr);
}
