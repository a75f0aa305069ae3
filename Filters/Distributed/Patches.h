// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/DistributedMesh.h"

#include "Mesh/NodePartition.h"
#include "Quality/InvertedBefore.h"
#include "Support/Monitor.h"

#include <cstddef>
#include <vector>

namespace morph::distributed
{
struct PatchLimits
{
  int rings = 8;       ///< of cells around the seeds
  double share = 0.25; ///< of the mesh's cells that all patches may have
  Index few = 20000;   ///< or this many cells, whatever share that is
};

struct PatchReport
{
  Index patches = 0, cells = 0; ///< of all ranks
  Index failed = 0;             ///< patches that stay as they are: their repair threw
  double bytes = 0;             ///< sent to the ranks that repair, and back, by all ranks
  bool isTooLarge = false;      ///< beyond the limits: nothing was done
};

/// Repairs a mesh in patches around some cells, each on one rank by morph::InversionFree::repair().
/// Patches that touch are one; the nodes on a patch's rim stay. `reference`, `moved`: #local nodes
/// x 3, see morph::Morpher::setReference(); `moved` is the start and the result, ghosts included.
/// `seeds`: local cells that are no ghosts; cells of `before` (local) are in no patch. The mesh has
/// no polyhedra. Throws Error on all ranks where a rank runs out of memory or the user cancels.
/// Collective. Cost: for each cell of a patch one message item of 8 bytes a corner, and 96 bytes a
/// node.
PatchReport repairPatches(const DistributedMesh& mesh, const Points& reference,
  const NodePartition& partition, const std::vector<Index>& seeds, const InvertedBefore& before,
  const PatchLimits& limits, Points& moved, Monitor& monitor);

struct RepairReport
{
  Index bad = 0;      ///< inverted or degenerate cells that are left and count, of all ranks
  Index tooLarge = 0; ///< cells of patches beyond the limits, or 0
  Index cells = 0;    ///< that the mesh has
};

/// Repairs the inverted and degenerate cells of `moved` by repairPatches(), with 6, 12 and then 24
/// rings of cells around those that are left. Keeps the mesh with the fewest. Cells of `before`
/// (local) that are no worse do not count.
RepairReport repairInverted(const DistributedMesh& mesh, const Points& reference,
  const NodePartition& partition, const InvertedBefore& before, Points& moved, Monitor& monitor);
}
