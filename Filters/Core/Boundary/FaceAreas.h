// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// Returns the vector area of each face, #faces x 3: its unit normal by the right-hand rule times
/// its area. `points`: #nodes x 3. Cost: one pass over the faces.
Points faceAreas(const ConstPoints& points, const BoundaryFaces& faces);

/// Returns unit normals at `nodes` (from faces.nodes, ascending), #nodes x 3. A normal is the
/// direction of the summed `areas` (#faces x 3) of the node's faces. If any of them have a nonzero
/// entry in `isChosen` (#faces), only these count. A mid-side or face node takes the faces with all
/// the corners it is between. Throws Error naming nodes whose areas cancel or are all zero. Cost:
/// one pass over the faces.
Points nodeNormals(const Points& areas, const BoundaryFaces& faces,
  const std::vector<std::uint8_t>& isChosen, const std::vector<Index>& nodes);
}
