// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/Classification.h"
#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"

#include <vector>

namespace morph
{
/// Numbers of the boundary faces that a motion folds, ascending: faceQuality() is 0 or less, and
/// the fold can be seen at the face alone (a quadrilateral whose corners turn different ways) or at
/// the rim of a patch of the others (at half or more of its edges inside the surface the faces on
/// both sides look against each other). The rim tells folds from surfaces that bend so much that
/// the sign of faceQuality() means nothing. `rest`, `moved`: #nodes x 3. Cost: faceQuality()'s, and
/// a pass over the edges.
std::vector<Index> foldedFaces(const ConstPoints& rest, const ConstPoints& moved,
  const BoundaryFaces& faces, const Classification& geometry);

/// Those of them all nodes of which are fixed. `isFixed`: #nodes, not 0 where a node is.
std::vector<Index> foldedFaces(const ConstPoints& rest, const ConstPoints& moved,
  const BoundaryFaces& faces, const Classification& geometry, const std::vector<char>& isFixed);
}
