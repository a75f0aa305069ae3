// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Private/Data/GridMesh.h"

#include <vtkSmartPointer.h>

#include <string>
#include <vector>

class vtkDataObjectTree;
class vtkUnstructuredGrid;

namespace morph::filters
{
/// The blocks of composite data as one mesh.
struct MergedBlocks
{
  /// One block that is not null, in the order of Leaves::Of().
  struct Block
  {
    std::string Name;
    std::vector<morph::Index> Nodes; ///< of each point, -1 for none; empty: it passes unchanged
    std::vector<morph::Index> Cells; ///< of each cell, if it is a part of the mesh
    bool IsMesh = false;
    /// Of each cell, where the block is on the mesh but no part of it: the mesh's cells that have
    /// all of its points.
    std::vector<std::vector<morph::Index>> Behind;
  };
  struct Options
  {
    bool Merges = true; ///< coincident points of blocks are one node
    bool ByIds = true;  ///< where blocks have global ids, these tell which points coincide
    GridMesh::UnknownCells Unknown = GridMesh::UnknownCells::Refuse;
  };

  /// The nodes and cells, with the arrays that all blocks have and the cell array MorphBlockId, the
  /// flat index of the block; and with marks of the nodes of named sets, see BlockSets::Name().
  /// Without cells where no block has any.
  vtkSmartPointer<vtkUnstructuredGrid> Grid;
  std::vector<Block> All;
  std::vector<morph::Index> BlockOfCell; ///< #cells of Grid, places in All
  std::vector<std::string> Warnings;

  /// Throws morph::Error, which names the block, for data that cannot be read. Cost: one pass over
  /// the blocks.
  static MergedBlocks Make(vtkDataObjectTree* tree, const Options& options);
};
}
