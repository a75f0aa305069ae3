// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Private/Blocks/MergedBlocks.h"

class vtkDataObjectTree;

/// Composite data whose blocks, or pieces of blocks, are on several MPI processes.
namespace morph::filters::RankBlocks
{
/// MergedBlocks::Make() on all processes: each merges its own blocks, and nodes and cells get ids
/// that are the same for all of them, which are the grid's global ids, too. Cells that another
/// process has become ghost cells. The grid of a process has also the nodes of its sets that only
/// other processes' cells have. `tree`: null where this process has none. Warnings are on the first
/// process alone. Throws morph::Error on all processes. Collective; not to be called unless
/// Ranks::TakePieces().
MergedBlocks Make(vtkDataObjectTree* tree, MergedBlocks::Options options);
}
