// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Topology.h"
#include "Support/Adjacency.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// Columns of nodes off a wall, through layers of hexahedra and wedges.
struct WallLayers
{
  std::vector<Index> walls; ///< node ids, ascending
  Adjacency columns;        ///< of each wall node: the nodes above it, outwards; perhaps none
};

/// Finds up to `most` layers. A layer is made of the cells whose face is a wall's, or the opposite
/// face of the layer before: hexahedra and, on triangles, wedges. A column ends where a cell around
/// it is of another shape, and at a node of the wall or of another column. It also ends before a
/// cell whose opposite face is on the boundary. `isWall`: #faces of `faces`. `isLayer`: #cells, the
/// only cells that count; none: all. Cost: a pass over the mesh, and one over the layers.
WallLayers findWallLayers(const Mesh& mesh, const BoundaryFaces& faces,
  const std::vector<std::uint8_t>& isWall, Index most, const std::vector<std::uint8_t>& isLayer);
}
