// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Private/Blocks/Leaves.h"
#include "Private/Blocks/MergedBlocks.h"

/// Blocks that are no part of the mesh, but lie on its nodes: side sets, node sets, patches.
namespace morph::filters::BlockSets
{
/// For each of them with a name, adds a point array to the grid, which marks its nodes. Adds the
/// name to the field data SurfaceNames, so that it can be chosen as a surface; see FindNamedSets().
/// A name that a point array of the mesh has already is left out.
void Name(const std::vector<Leaves::Leaf>& leaves, MergedBlocks& merged);

/// Finds for each of their cells the mesh's cells that have all of its points (Block::Behind).
/// Cost: a search for each of these cells.
void FindBehind(const std::vector<Leaves::Leaf>& leaves, MergedBlocks& merged);
}
