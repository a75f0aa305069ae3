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

/// Describes faces that are known to be on the boundary: of each the cell, a volume cell, and the
/// number of the face as in BoundaryFaces::sides. Cost: one pass over the faces.
BoundaryFaces facesAt(const Mesh& mesh, const std::vector<std::pair<Index, int>>& places);
}
