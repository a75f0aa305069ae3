// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/WallLayers.h"
#include "Mesh/Topology.h"

#include <vector>

namespace morph
{
/// Moves the columns of `layers` with the wall: each by its wall node's displacement and local
/// rotation, so that heights and angles to the wall stay. The rotation takes the undeformed normal
/// to the moved one, and is else the nearest one to the motion of the wall's edges at the node.
/// Nodes on the boundary outside the wall then go to the nearest point of the tangent planes of
/// their moved faces there.
///
/// `moved`: #nodes x 3, positions of all boundary nodes, perhaps of others; the columns' rows are
/// set. `isWall`: #faces. Cost: a pass over the wall's faces, and one over the columns.
void moveLayers(const Points& rest, const BoundaryFaces& faces,
  const std::vector<std::uint8_t>& isWall, const WallLayers& layers, Points& moved);
}
