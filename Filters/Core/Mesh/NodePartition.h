// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"

#include <vector>

namespace morph
{
/// Who moves how. Every node is in one of four groups: prescribed, free, higher-order, or none of
/// them (a node that no volume cell uses): those stay.
struct NodePartition
{
  std::vector<Index> prescribed; ///< sorted, unique: the caller gives their new positions
  std::vector<Index> free;       ///< sorted: corners of volume cells that the method solves for
  /// sorted: mid-side, face and body nodes of quadratic cells, not prescribed
  std::vector<Index> higherOrderNodes;
};

/// Sorts and checks `prescribed` (Error naming ids that do not exist or come twice) and derives the
/// rest.
NodePartition partitionNodes(const Mesh& mesh, std::vector<Index> prescribed);

/// For methods that work through the mesh's connectivity: throws Error of kind Singular naming the
/// first body none of whose corner nodes is prescribed.
void requirePrescribedBodies(
  const Mesh& mesh, const ConnectedComponents& parts, const NodePartition& partition);
}
