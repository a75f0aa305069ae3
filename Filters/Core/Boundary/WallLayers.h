// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Topology.h"
#include "Support/Communicator.h"
#include "Support/Lists.h"

#include <cstdint>
#include <map>
#include <vector>

namespace morph
{
/// Columns of nodes off a wall, through layers of hexahedra and wedges.
struct WallLayers
{
  std::vector<Index> walls; ///< nodes' numbers in the whole mesh, ascending
  Adjacency columns;        ///< of each wall node: the nodes above it, outwards; perhaps none
};

/// `columns`: of each wall node.
WallLayers wallLayers(const std::map<Index, std::vector<Index>>& columns);

/// Finds up to `most` layers. A layer is made of the cells whose face is a wall's, or the opposite
/// face of the layer before: hexahedra and, on triangles, wedges. A column ends where a cell around
/// it is of another shape, and at a node of the wall or of another column. It also ends before a
/// cell whose opposite face is on the boundary. `isWall`: #faces of `faces`. `isLayer`: #cells, the
/// only cells that count; none: all. Cost: a pass over the mesh, and one over the layers.
///
/// On several `processes` each has copies of the cells around its own ones' nodes. `faces` and
/// `isLayer` are those of its own cells, and it gets the columns' nodes that count on it.
/// Collective; cost: for each layer three exchanges and two passes over nodes and cells more.
WallLayers findWallLayers(const Mesh& mesh, const BoundaryFaces& faces,
  const std::vector<std::uint8_t>& isWall, Index most, const std::vector<std::uint8_t>& isLayer,
  const Communicator& processes = Communicator::alone());
}
