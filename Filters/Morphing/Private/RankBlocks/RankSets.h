// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/Ranks.h"
#include "Distributed/SharedPlaces.h"
#include "Private/Blocks/Leaves.h"
#include "Private/Blocks/MergedBlocks.h"

#include <string>
#include <vector>

namespace morph::filters
{
/// Blocks that are no part of the mesh, but lie on its nodes, which may be on other MPI processes.
/// All functions are collective.
class RankSets
{
public:
  const morph::distributed::Ranks& Ranks;
  const std::vector<Leaves::Leaf>& Mine;    ///< the leaves of this process
  const std::vector<morph::Index>& Numbers; ///< of the leaves' blocks, for all processes
  morph::Index Blocks;                      ///< how many all processes have
  const morph::distributed::SharedPlaces& Places;

  /// Finds the nodes of these blocks. Nodes of other processes alone are added to the grid, without
  /// cells, and to NodeIds. `warnings`: receives those of the whole data. Returns the numbers of
  /// the blocks of lines or faces that hang on the mesh by some of their points.
  std::vector<morph::Index> Follow(
    bool byIds, MergedBlocks& merged, std::vector<std::string>& warnings) const;

  /// BlockSets::Name() with the names of all processes.
  void Name(MergedBlocks& merged) const;

private:
  /// How many points of each block are on a node, and on none. NoPart: above 0 if the block cannot
  /// hang on the mesh.
  struct Counts
  {
    std::vector<morph::Index> Found, Missing, NoPart;
  };
  Counts FindNodes(
    const std::vector<morph::distributed::SharedPlaces::Place>& places, MergedBlocks& merged) const;
  std::vector<morph::Index> Warn(
    Counts counts, const MergedBlocks& merged, std::vector<std::string>& warnings) const;
};
}
