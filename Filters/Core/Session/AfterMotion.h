// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/HangingNodes.h"
#include "Mesh/Mesh.h"
#include "Mesh/NodePartition.h"
#include "Support/Communicator.h"
#include "Support/Monitor.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace morph
{
class Morpher;

/// Sets what `method` needs on the pieces of polyhedra (PolyhedronPieces.h), if it is the
/// inversion-free one.
void adaptToPieces(Morpher& method);

/// Repairs a mesh with polyhedra or divided faces, its nodes at `moved`, #nodes x 3, in rounds.
/// Each puts the centers back to the means of their nodes, repairs the pieces, and ties what hangs.
/// The mesh with the fewest bad polyhedra and other cells is kept. Returns whether none are left.
/// Ends where the boundary itself inverts a piece of each that is left. `reference`: see
/// Morpher::setReference(). `bad`: returns those among this process's own cells, ascending.
bool repairPolyhedra(const Mesh& mesh, const HangingNodes& hanging, const Points& reference,
  const NodePartition& partition,
  const std::function<std::vector<Index>(const Points& points)>& bad, Points& moved,
  Monitor& monitor, const Communicator& processes = Communicator::alone());

/// Smooths `moved`, #nodes x 3, towards the undeformed shapes, and never to a worse mesh. Returns
/// the steps that led to it, 0 where nothing is better. `onPieces`: by the pieces of polyhedra and
/// of cells at divided faces, where any process has some. `orientation`: #cells.
Index smoothAfterwards(const Mesh& rest, const HangingNodes& hanging, bool onPieces,
  const std::vector<std::int8_t>& orientation, const NodePartition& partition, int iterationLimit,
  Points& moved, Monitor& monitor, const Communicator& processes = Communicator::alone());
}
