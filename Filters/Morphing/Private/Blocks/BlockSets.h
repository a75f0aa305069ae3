// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Private/Blocks/Leaves.h"
#include "Private/Blocks/MergedBlocks.h"

#include <map>
#include <string>
#include <vector>

/// Blocks that are no part of the mesh, but lie on its nodes: side sets, node sets, patches.
namespace morph::filters::BlockSets
{
/// Nodes of the sets of each name. Sets of one name, as partitions have, share an entry.
using Marks = std::map<std::string, std::vector<morph::Index>>;

/// For each of them with a name, adds a point array to the grid, which marks its nodes. Adds the
/// name to the field data SurfaceNames, so that it can be chosen as a surface; see FindNamedSets().
/// A name that a point array of the mesh has already is left out.
void Name(const std::vector<Leaves::Leaf>& leaves, MergedBlocks& merged);

/// Adds point arrays that mark the nodes, and their names, as Name() does.
void AddMarks(const Marks& marks, vtkUnstructuredGrid* grid);

/// Finds for each of their cells the mesh's cells that have all of its points (Block::Behind).
/// Cost: a search for each of these cells.
void FindBehind(const std::vector<Leaves::Leaf>& leaves, MergedBlocks& merged);
}
