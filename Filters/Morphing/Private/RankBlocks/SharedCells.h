// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/Ranks.h"
#include "Mesh/Mesh.h"

#include <cstdint>
#include <vector>

class vtkDataArray;
class vtkUnstructuredGrid;

/// Cells of pieces on several MPI processes. All functions but two are collective.
namespace morph::filters::SharedCells
{
/// #cells: nonzero for copies of other processes' cells. Not collective.
std::vector<std::uint8_t> Ghosts(vtkUnstructuredGrid* grid);

/// The values of an array of whole numbers; none of null. Not collective.
std::vector<std::int64_t> Numbers(vtkDataArray* array);

/// Makes ghosts of cells that another process has, too: of those with the same nodes the lowest
/// process keeps its one. `ids`, `isShared`: of the grid's nodes; see SharedPlaces.
void MarkGhosts(const morph::distributed::Ranks& ranks, const std::vector<std::int64_t>& ids,
  const std::vector<std::uint8_t>& isShared, vtkUnstructuredGrid* grid);

/// Returns the ids of the grid's cells: their global ids, if all cells of all processes have one of
/// their own, else new ones, which ghosts have not (-1).
std::vector<morph::Index> Ids(const morph::distributed::Ranks& ranks, vtkUnstructuredGrid* grid);
}
