// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"

#include <vector>

namespace morph
{
/// The nodes by how they move: prescribed, free, higher-order, or fixed. Fixed nodes are those that
/// no volume cell uses; they are in none of the lists.
struct NodePartition
{
  std::vector<Index> prescribed; ///< sorted, unique: the caller gives their positions
  std::vector<Index> free;       ///< sorted: corners of volume cells, the method's unknowns
  /// sorted: mid-side, face and body nodes of quadratic cells that are not prescribed
  std::vector<Index> higherOrderNodes;
};

/// Sorts `prescribed` and derives the other groups. Throws Error naming ids that do not exist or
/// occur twice.
NodePartition partitionNodes(const Mesh& mesh, std::vector<Index> prescribed);

/// Throws Error of kind Singular unless each body has a prescribed corner node; the message names
/// the first that has none. For methods that work through the mesh's connectivity. Collective.
void requirePrescribedBodies(const ConnectedComponents& parts, const NodePartition& partition,
  const Communicator& processes = Communicator::alone());

/// Orders the free nodes as matrix rows. Keeps the order of ids where neighbors are near in memory
/// (structured and swept meshes). Otherwise sorts along a space-filling curve: Delaunay generators
/// number at random, 2.5 times slower on 130,000 nodes. `free`: sorted. Cost: one pass over the
/// cells, plus the sort.
std::vector<Index> unknownOrdering(const Mesh& mesh, const std::vector<Index>& free);

/// Returns the index in `free` of a row's node, for rows = unknownOrdering(mesh, free), or of a
/// part of `free`.
Index indexInFree(const std::vector<Index>& rows, const std::vector<Index>& free, Index row);
}
