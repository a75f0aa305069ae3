// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/DistributedMesh.h"

#include "LinearMethods/AttachedNodes.h"
#include "Mesh/NodePartition.h"

namespace morph::distributed
{
/// AttachedNodes of a distributed mesh, the same on all ranks; ids are global. `partition`: of
/// mesh.mesh(). `mesh` has to outlive the result. Collective. Cost: each rank gets all links.
AttachedNodes attachedNodes(const DistributedMesh& mesh, const NodePartition& partition);
}
