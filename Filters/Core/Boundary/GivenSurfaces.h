// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/Classification.h"

namespace morph
{
/// The surface ids of faces and the curve edges that follow from the given geometry. Empty where
/// nothing is given.
struct GivenSurfaces
{
  std::vector<Index> id;             ///< #faces, surface id, NoGeometry where unknown
  std::vector<std::uint8_t> isCurve; ///< #edges: a given curve runs along it
  /// Number of faces examined for an id, a measure of the cost. At most 10 times #faces.
  Index visits = 0;
};

/// Derives ids from `given.surface`, or else from the nodes:
/// 1. A face has the id of its surface nodes.
/// 2. A face without one takes the id of a neighbor. The edge between them cannot lie on a curve,
///    as its ends are given to different ones.
/// 3. Curves run along edges between known surfaces with different ids. Then along edges that join
///    nodes given to one curve, the shortest first, while both nodes lack one of their two curve
///    edges (this excludes chords). Then along features that join two vertices. Last, from the end
///    node of a curve to a vertex, the straightest way.
/// 4. A face still without an id takes the id of a neighbor over an edge that is neither a curve
///    nor a feature, if there is one.
/// Throws Error naming nodes of one face that are given to different surfaces. Cost: a sort of the
/// edges.
GivenSurfaces givenSurfaces(const ConstPoints& points, const BoundaryFaces& faces,
  const SurfaceEdges& edges, const ClassificationOptions& options);
}
