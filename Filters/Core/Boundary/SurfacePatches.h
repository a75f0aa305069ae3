// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/SurfaceEdges.h"

#include <limits>
#include <vector>

namespace morph
{
/// The id where none is given.
constexpr Index NoGeometry = std::numeric_limits<Index>::min();

/// The partition of boundary faces into connected patches.
struct SurfacePatches
{
  /// #faces, patch number; numbered by their lowest face, as sorted node ids
  std::vector<Index> ofFace;
  std::vector<Index> id;             ///< #patches, the id given to its faces, or NoGeometry
  std::vector<std::uint8_t> isCurve; ///< #edges: a feature, or a border of patches or ids
};

/// Finds patches by flood fill over the boundary faces. `featureAngle`: degrees; an edge is a
/// feature where the angle exceeds it or not exactly two faces meet. `ids`: #faces given surface
/// ids, NoGeometry where unknown; or empty. Connected faces with the same id are one patch;
/// features between them count only with `featuresInside`. Faces without an id are joined over
/// edges that are neither features nor `curves`, and never to a face with an id. `curves`: #edges,
/// nonzero on known curves; or empty. Cost: near linear.
SurfacePatches surfacePatches(const BoundaryFaces& faces, const SurfaceEdges& edges,
  double featureAngle, const std::vector<Index>& ids, const std::vector<std::uint8_t>& curves,
  bool featuresInside);
}
