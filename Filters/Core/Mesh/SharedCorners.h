// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"
#include "Support/Monitor.h"

#include <vector>

namespace morph
{
/// The corners of a volume cell or nodes of a poly-vertex, each once, ascending; else none.
std::vector<Index> cornersOf(const Mesh& mesh, Index cell);

/// Returns the volume cells, ascending, that have the same corners as another one, and the
/// poly-vertices that recognizeCells() has made of them. Cost: a sort of the cells by their lowest
/// corner.
std::vector<Index> repeatedCells(const Mesh& mesh, Monitor& monitor);

/// Returns the nodes, ascending, where cells meet that are not joined by faces there, as where two
/// bodies share a node by chance. Two cells are joined if they have three corners in common. Left
/// out are all corners of an outer face if they are all such nodes: a cell of one side meets
/// several of the other side there. `mesh`: HangingNodes::conforming() where faces are divided on
/// one side alone. `faces`: the mesh's boundaryFaces(). Cost: a pass over the faces and, where
/// there may be such nodes, one over the cells.
std::vector<Index> touchingNodes(const Mesh& mesh, const BoundaryFaces& faces);

/// The number of mirrored bodies: those that have cells of orientation -1. `orientation`: #cells,
/// see cellSigns(). Collective.
Index mirroredBodies(const ConnectedComponents& bodies, const std::vector<std::int8_t>& orientation,
  const Communicator& processes = Communicator::alone());
}
