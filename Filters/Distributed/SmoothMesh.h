// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/DistributedMesh.h"

#include "Mesh/NodePartition.h"
#include "Support/Monitor.h"
#include "Untangling/SmoothMesh.h"

namespace morph::distributed
{
/// morph::smoothMesh() of a distributed mesh without polyhedra: each rank computes the measure of
/// its own cells. `rest`, `moved`: #local nodes x 3; `rest` has the undeformed positions, and
/// `moved` is the start and the result, ghosts included. Throws Error on all ranks. Collective.
SmoothingReport smoothMesh(const DistributedMesh& mesh, const Points& rest,
  const NodePartition& partition, const SmoothingOptions& options, Points& moved, Monitor& monitor);
}
