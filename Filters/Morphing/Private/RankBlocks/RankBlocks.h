// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Private/Blocks/MergedBlocks.h"
#include "Private/Blocks/ShellGrid.h"

class vtkDataObjectTree;
class vtkUnstructuredGrid;

/// Meshes whose blocks or pieces are on several MPI processes. Its functions are collective, and
/// throw morph::Error on all processes; not to be called unless Ranks::TakePieces().
namespace morph::filters::RankBlocks
{
/// MergedBlocks::Make() on all processes: each merges its own blocks, and nodes and cells get ids
/// that are the same for all of them, which are the grid's global ids, too. Cells that another
/// process has become ghost cells. The grid of a process has also the nodes of its sets that only
/// other processes' cells have. `tree`: null where this process has none. Warnings are on the first
/// process alone.
MergedBlocks Make(vtkDataObjectTree* tree, MergedBlocks::Options given);

/// The solid of this process's piece of a mesh of faces. Its front has the nodes of the piece and,
/// behind these, those of other processes' cells that methods see; see morph::thicken().
ShellGrid::Solid Thicken(vtkUnstructuredGrid* piece);
}
