// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/SurfaceEdges.h"

#include <limits>
#include <vector>

namespace morph
{
/// Where no id of a geometry is given.
constexpr Index NoGeometry = std::numeric_limits<Index>::min();

/// Boundary faces in connected patches.
struct SurfacePatches
{
  /// #faces, patch number; numbered by their lowest face, as sorted node ids
  std::vector<Index> ofFace;
  std::vector<Index> id;             ///< #patches, the id given to its faces, or NoGeometry
  std::vector<std::uint8_t> isCurve; ///< #edges: patches, or ids, meet there, or it is a feature
};

/// Flood fill over the boundary faces. `featureAngle`: degrees; an edge is a feature where it is
/// exceeded, or where not exactly two faces meet. `ids`: #faces given surface ids, NoGeometry where
/// unknown; or empty. Faces with the same id are one patch as far as they hang together, features
/// between them notwithstanding, unless `featuresInside`. Faces without an id are joined over edges
/// that are neither features nor `curves` (#edges, nonzero where a curve is known to run; or
/// empty), and never to one that has an id. Cost: near linear.
SurfacePatches surfacePatches(const BoundaryFaces& faces, const SurfaceEdges& edges,
  double featureAngle, const std::vector<Index>& ids, const std::vector<std::uint8_t>& curves,
  bool featuresInside);
}
