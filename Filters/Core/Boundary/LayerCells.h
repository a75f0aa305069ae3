// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"
#include "Support/Adjacency.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// A face of a cell from which the next layer of cells grows, and the face that lies opposite.
struct LayerFront
{
  Index cell;
  int size; ///< 3 or 4
  Index nodes[4];
  Index opposite[4]; ///< of each of `nodes`
};

/// Finds the cells through which layers grow: hexahedra and, from triangles, wedges.
class LayerCells
{
public:
  /// `outerNodes`: those of the boundary. `isLayer`: #cells, the only cells that count; none: all.
  /// Holds `mesh` and `isLayer` by reference. Cost: a pass over the mesh.
  LayerCells(const Mesh& mesh, const std::vector<Index>& outerNodes,
    const std::vector<std::uint8_t>& isLayer);

  /// The side of `cell` (CellShape::faces) with these nodes, from which a layer grows into it. -1
  /// where the cell has no layer there.
  int sideOf(Index cell, const Index* nodes, Index size) const;
  /// `side`: one that sideOf() tells.
  LayerFront front(Index cell, int side) const;
  /// The cell beyond the opposite face, or -1 at the boundary.
  Index beyond(const LayerFront& front) const;
  bool isOuter(Index node) const { return this->isOuter_[node] != 0; }

private:
  const Mesh& mesh_;
  Adjacency around_;
  const std::vector<std::uint8_t>& isLayer_;
  std::vector<std::uint8_t> isOuter_; ///< #nodes
};
}
