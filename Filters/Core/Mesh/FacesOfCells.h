// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Topology.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace morph
{
/// Returns those boundary faces that belong to a cell with a nonzero entry in `isOf` (#cells), with
/// the nodes on them. `faces`: boundaryFaces(mesh). Cost: one pass over the faces.
BoundaryFaces facesOfCells(
  const Mesh& mesh, const BoundaryFaces& faces, const std::vector<std::uint8_t>& isOf);

/// Returns the faces from `first` to before `last`, with the nodes on them, in the same way: with
/// the corners that their edges were given where they are divided (HangingNodes.h).
BoundaryFaces facesBetween(const Mesh& mesh, const BoundaryFaces& faces, Index first, Index last);

/// Gives faces other corners. Those that were no corners before are nodes of the boundary now, and
/// between no others.
void setCorners(std::vector<Index> offsets, std::vector<Index> connectivity, BoundaryFaces& faces);

/// Describes faces that are known to be on the boundary: of each the cell, a volume cell, and the
/// number of the face as in BoundaryFaces::sides. Cost: one pass over the faces.
BoundaryFaces facesAt(const Mesh& mesh, const std::vector<std::pair<Index, int>>& places);
}
