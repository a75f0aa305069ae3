// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/Classification.h"
#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"

#include <vector>

namespace morph
{
/// Returns the boundary faces, ascending, that a motion folds: their faceQuality() is 0 or less,
/// and the fold is visible. It is visible at the face itself if a quadrilateral's corners turn
/// different ways. Or it is visible at the rim of a patch of other such faces. There, at half or
/// more of the edges inside the surface, the faces on both sides oppose each other. The rim
/// distinguishes folds from strong bends, where the sign of faceQuality() is meaningless. `rest`,
/// `moved`: #nodes x 3. Cost: that of faceQuality(), and a pass over the edges.
std::vector<Index> foldedFaces(const ConstPoints& rest, const ConstPoints& moved,
  const BoundaryFaces& faces, const Classification& geometry);

/// Returns the folded faces with fixed nodes only. `isFixed`: #nodes, nonzero where a node is
/// fixed.
std::vector<Index> foldedFaces(const ConstPoints& rest, const ConstPoints& moved,
  const BoundaryFaces& faces, const Classification& geometry, const std::vector<char>& isFixed);
}
