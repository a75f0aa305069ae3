// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "TestGrids.h"

#include <vtkMultiBlockDataSet.h>
#include <vtkPartitionedDataSetCollection.h>

#include <map>

class vtkDataObjectTree;

/// Composite data for the tests of the filters.
namespace blocks
{
using Pieces = std::vector<vtkSmartPointer<vtkUnstructuredGrid>>;

/// Cuts a grid: each cell goes to the piece `pieceOf` its center. A piece has nodes of its own, in
/// ascending order, with all arrays. `withIds`: with global ids of points and cells, in the order
/// of the grid's.
Pieces cut(vtkUnstructuredGrid* grid, int pieces,
  const std::function<int(const grids::Row&)>& pieceOf, bool withIds);
/// A grid in four pieces around the z axis.
Pieces quarters(vtkUnstructuredGrid* grid, bool withIds);
/// `quarters`, put together again in the order of the pieces and their points: what a mesh of them
/// has to be without global ids.
vtkSmartPointer<vtkUnstructuredGrid> joined(const Pieces& pieces);

/// Two levels: {"Solid": {"A", null, "B"}, "C", "D", ...}.
vtkSmartPointer<vtkMultiBlockDataSet> multiBlock(const Pieces& pieces);
/// Named "A", "B", ..., the first two as the partitions of one.
vtkSmartPointer<vtkPartitionedDataSetCollection> collection(const Pieces& pieces);

/// The data sets in order, null ones left out.
std::vector<vtkSmartPointer<vtkDataObject>> leaves(vtkDataObject* tree);
vtkUnstructuredGrid* grid(vtkDataObject* tree, std::size_t leaf);
/// The points of all leaves by their array `Number`. It is an error of the test where two points of
/// one number differ in a bit.
std::map<vtkIdType, grids::Row> pointsByNumber(vtkDataObject* tree);
/// A cell array of all leaves by their array `Cell`.
std::map<vtkIdType, double> cellsByNumber(vtkDataObject* tree, const char* name);
}
