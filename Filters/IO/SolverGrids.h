// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

class vtkPartitionedDataSetCollection;
class vtkUnstructuredGrid;

namespace morph::io
{
struct SolverMesh;

/// Fills `grid` with the mesh of the file `path`, its numbers and its named sets: the arrays that
/// vtkSolverFileReader documents.
void fillGrid(const SolverMesh& mesh, const std::string& path, vtkUnstructuredGrid* grid);

/// Fills `blocks`: the elements as the block "Mesh", and a block for each named set that has nodes
/// or cells. Each has the arrays of the grid that fillGrid() makes. Cost: for each set one pass
/// over the nodes and over the members of all sets.
void fillBlocks(
  const SolverMesh& mesh, const std::string& path, vtkPartitionedDataSetCollection* blocks);
}
