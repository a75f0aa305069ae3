// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/Ranks.h"

#include "Mesh/Mesh.h"

#include <cstdint>
#include <vector>

namespace morph::distributed
{
/// One rank's part of a mesh. Each cell is on one rank; the others may have copies, as ghosts.
struct Piece
{
  Mesh mesh;
  std::vector<std::uint8_t> isGhost; ///< #cells, or empty for none
  std::vector<std::int64_t> nodeIds; ///< #nodes, global, not negative; or empty
  std::vector<std::int64_t> cellIds; ///< #cells, global; or empty
};

/// #nodes: nonzero for those of cells that are not ghosts.
std::vector<std::uint8_t> usedNodes(const Mesh& mesh, const std::vector<std::uint8_t>& isGhost);

/// Gives each node a global id where no rank has ids: nodes of different ranks at the same position
/// are one node. Throws Error on all ranks if some ranks with nodes have ids and others have none.
/// Throws too if the own cells of a rank have several nodes at a position that another rank has
/// too: ids alone tell which of them are one. Collective. Cost: that of SharedPlaces.
void requireNodeIds(const Ranks& ranks, Piece& piece);

/// Returns new ids of the cells that are no ghosts, rank by rank; -1 for ghosts. Collective.
std::vector<std::int64_t> newCellIds(const Ranks& ranks, const std::vector<std::uint8_t>& isGhost);

/// Gives cells new ids where no rank has ids. Throws as above. Collective.
void requireCellIds(const Ranks& ranks, Piece& piece);
}
