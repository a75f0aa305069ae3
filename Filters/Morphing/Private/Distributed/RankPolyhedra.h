// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/DistributedMesh.h"
#include "Distributed/Patches.h"
#include "Mesh/NodePartition.h"
#include "Quality/InvertedBefore.h"
#include "Support/Monitor.h"

/// What changes a distributed mesh after a method. It sees the pieces of polyhedra, and of cells at
/// divided faces; nodes that hang follow. All functions are collective. `moved`: #local nodes x 3,
/// the start and the result.
namespace morph::filters::RankPolyhedra
{
/// morph::distributed::repairInverted() or, on pieces, rounds of it. Cells of
/// `before` (local) were inverted before, and do not count unless they are worse.
morph::distributed::RepairReport Repair(const morph::distributed::DistributedMesh& mesh,
  const morph::Points& reference, const morph::NodePartition& partition, bool needsPieces,
  const morph::InvertedBefore& before, morph::Points& moved, morph::Monitor& monitor);

/// Smooths towards the undeformed shapes; returns the steps, 0 where the mesh stays. See Session.
morph::Index Smooth(const morph::distributed::DistributedMesh& mesh, const morph::Points& rest,
  const morph::NodePartition& partition, bool needsPieces, int iterationLimit, morph::Points& moved,
  morph::Monitor& monitor);
}
