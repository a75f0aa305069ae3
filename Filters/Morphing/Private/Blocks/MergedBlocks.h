// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Private/Data/GridMesh.h"

#include <vtkSmartPointer.h>

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

class vtkDataArray;
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
    /// On ranks, of lines or faces: none of their points that are on no node is next to one.
    bool MayHang = false;
  };
  struct Options
  {
    bool Merges = true; ///< coincident points of blocks are one node; of partitions they always are
    bool ByIds = true;  ///< where blocks have global ids, these tell which points coincide
    GridMesh::UnknownCells Unknown = GridMesh::UnknownCells::Refuse;
    /// Set where other MPI processes have blocks of the same mesh; see RankBlocks.
    bool AreOnRanks = false;
    int Dimension = 0; ///< cells of the mesh have it at least
    /// On ranks: paths of the blocks of lower dimension that hang on the mesh; see Leaves::Leaf.
    std::set<std::string> Attached;
  };

  /// The nodes and cells, with the arrays that all blocks have and the cell array MorphBlockId, the
  /// flat index of the block; and with marks of the nodes of named sets, see BlockSets::Name().
  /// Without cells where no block has any.
  vtkSmartPointer<vtkUnstructuredGrid> Grid;
  std::vector<Block> All;
  std::vector<morph::Index> BlockOfCell; ///< #cells of Grid, places in All
  std::vector<std::string> Warnings;

  /// Of blocks on several MPI processes, else empty: the ids of nodes and cells, the same for all
  /// processes.
  std::vector<morph::Index> NodeIds, CellIds;
  /// Of blocks on several MPI processes: for each block, as Behind, the lowest of the values of the
  /// mesh's cells behind each of its cells. `values`: of Grid's cells, or null. Collective.
  std::function<std::vector<std::vector<double>>(vtkDataArray* values)> WorstBehind;
  /// A global id of points at different places, where Options::ByIds. On ranks the rest is not
  /// made then.
  std::optional<morph::Index> Contradiction;

  /// Throws morph::Error, which names the block, for data that cannot be read. Cost: one pass over
  /// the blocks. On ranks only the mesh is made, without warnings; other blocks have no nodes yet,
  /// and NodeIds are the points' global ids, or -1.
  static MergedBlocks Make(vtkDataObjectTree* tree, const Options& options);
};
}
