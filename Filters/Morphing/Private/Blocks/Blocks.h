// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Private/Blocks/MergedBlocks.h"
#include "Private/Blocks/ShellGrid.h"
#include "Private/Data/GridMesh.h"

#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <utility>
#include <vector>

class vtkDataObject;
class vtkDataObjectTree;
class vtkInformationVector;
class vtkUnstructuredGrid;

namespace morph
{
class Monitor;
}

namespace morph::filters
{
/// The mesh on port 0 of a filter, which may come as composite data, and the output of its type.
///
/// Gather() merges the blocks into one grid, the filter writes into Output(), and Scatter() gives
/// the result to the blocks. With data that are not composite all three do nothing. Thicken() makes
/// a solid of a plane mesh, and Scatter() a plane mesh of the result.
///
/// The blocks with cells of the highest dimension are the mesh. So are shells and beams that hang
/// on it by some of their points, unless blocks are kept apart or on several MPI processes. Its
/// nodes are numbered by their global ids where all blocks have them, else in the order of the
/// blocks; so are its cells. Cells of two blocks with the same nodes are one, such as ghost cells
/// and zones. Other blocks with points at nodes, such as side sets, move with these. The rest
/// passes unchanged.
class Blocks
{
public:
  /// vtkMorphAlgorithm::CoincidentPointsType
  enum CoincidentPoints
  {
    Merge,
    MergeByPosition,
    KeepApart
  };

  /// What MergedBlocks calls them. `coincident`: CoincidentPoints.
  static MergedBlocks::Options OptionsOf(int coincident, GridMesh::UnknownCells unknown);

  /// For REQUEST_DATA_OBJECT: output 0 becomes composite data of the input's class, or an
  /// unstructured grid.
  static void MakeOutput(vtkInformationVector** inputVector, vtkInformationVector* outputVector);

  /// Returns `input`, or its blocks as one vtkUnstructuredGrid, which is kept while they have the
  /// same points, cells and arrays. `coincident`: CoincidentPoints. Throws as MergedBlocks::Make()
  /// does. Warns of blocks that pass unchanged. Cost: one pass over the blocks.
  vtkDataObject* Gather(
    vtkDataObject* input, int coincident, GridMesh::UnknownCells unknown, morph::Monitor& monitor);
  /// Gather() in steps, for blocks on several MPI processes; see RankBlocks. All of these call
  /// Scatter(), too.
  ///@{
  /// Takes `input`, perhaps no tree, and returns whether its merged blocks are kept.
  bool IsKept(vtkDataObject* input, int coincident, GridMesh::UnknownCells unknown);
  void Forget();
  void Keep(MergedBlocks merged);
  /// Warns, and returns the merged blocks.
  vtkDataObject* Tell(morph::Monitor& monitor) const;
  ///@}
  /// Makes a solid of what Gather() has returned if that is a plane mesh.
  ShellGrid& Shell() { return this->Plane; }

  /// The blocks of the last input; null where it was not composite.
  const MergedBlocks* Merged() const;
  vtkDataObjectTree* Tree() const;

  /// The grid to write: output 0, or one for Scatter().
  vtkUnstructuredGrid* Output(vtkInformationVector* outputVector);
  /// Gives the points and arrays of Output(), as far as they are new, to the blocks of output 0,
  /// and its field data to the output itself. An empty grid leaves an output without blocks.
  void Scatter(vtkInformationVector* outputVector);

private:
  using Key = std::vector<std::pair<const void*, vtkMTimeType>>;
  static Key KeyOf(
    vtkDataObjectTree* tree, int coincident, GridMesh::UnknownCells unknown, bool areOnRanks);

  vtkSmartPointer<vtkDataObjectTree> Input;
  vtkSmartPointer<vtkUnstructuredGrid> Scratch;
  Key MadeFrom, Asked;
  MergedBlocks Kept;
  ShellGrid Plane;
};
}
