// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/NodePartition.h"
#include "Support/Monitor.h"

namespace morph
{
/// Returns the graph-Laplace mesh: each free corner node lies at the mean of its neighbors along
/// the cells' edges. It depends on connectivity and prescribed nodes alone, so it is a start for a
/// mesh whose free nodes are in no useful place. `points`: #nodes x 3; prescribed nodes are read,
/// and all nodes that are not free corners keep their place. Each body needs a prescribed node. The
/// tolerance of the solution is 1e-6. Throws Error as SpdSolver. Cost: that of FemWarp. Source: W.
/// T. Tutte, Proc. London Math. Soc. 13 (1963) 743-767.
Points graphLaplaceMesh(
  const Mesh& mesh, const NodePartition& partition, const Points& points, Monitor& monitor);
}
