// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Private/Blocks/Leaves.h"
#include "Private/Blocks/MergedBlocks.h"

#include <vector>

class vtkDataArray;
class vtkUnstructuredGrid;

/// Gives what a filter made of the merged mesh to one block.
namespace morph::filters::BlockOutput
{
/// Replaces the leaf, a copy of the input's, by one with the points and arrays of `result`, as far
/// as they are not those of `merged.Grid`; arrays that `result` no longer has are removed.
/// `result`: a shallow copy of `merged.Grid` with other points or arrays. The leaf gets the point
/// array MorphPointId and, as part of the mesh, the cell array MorphCellId: numbers in `result`, on
/// several MPI processes ids of the whole mesh. A leaf without points of its own, such as an image,
/// becomes a vtkStructuredGrid where points moved. `block`: its place in `merged.All`. `behind`:
/// what MergedBlocks::WorstBehind says of the leaf, or empty.
void Write(const Leaves::Leaf& leaf, const MergedBlocks& merged, std::size_t block,
  vtkUnstructuredGrid* result, const std::vector<double>& behind = {});

/// The scaled Jacobians of `result` where `merged.Grid` has others, else null.
vtkDataArray* NewQuality(const MergedBlocks& merged, vtkUnstructuredGrid* result);

/// Replaces the leaf by those cells of `result` that are faces of the leaf's cells. The cell array
/// MorphCellId names the cell behind a face. `result`: faces on the nodes of `merged.Grid`.
void WriteFaces(const Leaves::Leaf& leaf, const MergedBlocks& merged, std::size_t block,
  vtkUnstructuredGrid* result);
}
