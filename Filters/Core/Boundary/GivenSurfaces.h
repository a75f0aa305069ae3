// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/Classification.h"

namespace morph
{
/// What the given geometry says of faces and edges. Empty where nothing is given.
struct GivenSurfaces
{
  std::vector<Index> id;             ///< #faces, surface id, NoGeometry where unknown
  std::vector<std::uint8_t> isCurve; ///< #edges: a given curve runs along it
  /// Faces that were looked at for an id: a measure of the cost. At most 10 times #faces.
  Index visits = 0;
};

/// Ids are `given.surface`, or else follow from the nodes:
/// 1. A face has the id of its surface nodes.
/// 2. A face without one takes that of a neighbor over an edge that cannot lie on a curve, as its
///    ends are given to different ones.
/// 3. Curves run along edges between known surfaces with different ids; then along edges that join
///    nodes given to one curve, the shortest first as long as both nodes lack one of their two
///    curve edges (so chords are left out); along features that join two vertices; and on from a
///    curve's last node to a vertex, the straightest way.
/// 4. A face still without an id takes that of a neighbor over an edge that is neither a curve nor
///    a feature, if there is one.
/// Throws Error naming nodes of one face that are given to different surfaces. Cost: a sort of the
/// edges.
GivenSurfaces givenSurfaces(const ConstPoints& points, const BoundaryFaces& faces,
  const SurfaceEdges& edges, const ClassificationOptions& options);
}
