// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"

#include <vector>

namespace morph::filters
{
class SharedNodes;

/// A block may have several points at one place, as on the two sides of a crack. The place does not
/// tell which of them a point of another block belongs to. The faces do: two blocks share the nodes
/// of the faces that they have in common.
namespace SplitNodes
{
/// A block of the mesh, and the node of each of its points.
struct Part
{
  const morph::Mesh& Mesh;
  std::vector<morph::Index>& Nodes;
};

/// Numbers the nodes again where `shared`, which numbered them, has more than one node at a place
/// and none of these has a global id. Returns for each old node the new one; for one of several at
/// a place, the first there. `number`: of nodes, changed too. Cost: where no place has several
/// nodes, a pass over the nodes.
std::vector<morph::Index> Join(
  const SharedNodes& shared, std::vector<Part>& parts, morph::Index& number);
}
}
