// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// The vector area of each face: its unit normal by the right-hand rule of its corners, times its
/// area. #faces x 3. `points`: #nodes x 3. Cost: one pass over the faces.
Points faceAreas(const ConstPoints& points, const BoundaryFaces& faces);

/// Unit normals at `nodes` (of faces.nodes, ascending): #nodes x 3, the direction of the sum of
/// `areas` (#faces x 3) of the faces round the node. Of those with a non-zero entry in `isChosen`
/// (#faces) alone, where there are any round the node. A mid-side or face node takes the faces that
/// have all the corners it is between. Throws Error naming nodes whose faces' areas cancel out or
/// are all zero, which have no normal. Cost: one pass over the faces.
Points nodeNormals(const Points& areas, const BoundaryFaces& faces,
  const std::vector<std::uint8_t>& isChosen, const std::vector<Index>& nodes);
}
