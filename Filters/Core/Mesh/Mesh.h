// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

#include <cstdint>
#include <string>
#include <vector>

namespace morph
{
/// A mesh in VTK's numbering: cell types are VTK's, and so is the order of the nodes in a cell.
struct Mesh
{
  Points points;                   ///< #nodes x 3
  std::vector<std::uint8_t> types; ///< #cells, VTK cell types (see CellShape.h)
  std::vector<Index> offsets;      ///< #cells + 1, where each cell starts in `connectivity`
  std::vector<Index> connectivity; ///< node ids of all cells, one cell after another

  Index numberOfNodes() const { return static_cast<Index>(this->points.rows()); }
  Index numberOfCells() const { return static_cast<Index>(this->types.size()); }
  const Index* cell(Index id) const { return this->connectivity.data() + this->offsets[id]; }
  Index cellSize(Index id) const { return this->offsets[id + 1] - this->offsets[id]; }
};

/// Throws Error unless every array has a consistent length, every node id exists, every coordinate
/// is finite, and every cell has the number of nodes its type asks for. Cells of a type that is not
/// in CellShape.h (polyhedra, for instance) are named. Cost: one pass over the mesh.
void validate(const Mesh& mesh);
}
