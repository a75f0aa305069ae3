// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Support/Monitor.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace morph
{
/// Returns the faces inside of the mesh on which two walls or more lie, one for each side: baffles.
/// `isWall`: #cells, nonzero for a wall; two-dimensional cells alone count. Each face is the lower
/// of its cells with the face's number, as in BoundaryFaces::sides, ascending. Cost: a pass over
/// the cells and, where walls coincide, that of faceTable().
std::vector<std::pair<Index, int>> baffleFaces(
  const Mesh& mesh, const std::vector<std::uint8_t>& isWall, Monitor& monitor);
}
