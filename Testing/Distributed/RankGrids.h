// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/Ranks.h"
#include "Mesh/Mesh.h"

#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include <functional>

/// Grids of which each MPI rank has a piece, and the serial filters on all of one.
namespace rankgrids
{
/// This rank's cells of a mesh in a random partition, with global ids and the arrays of
/// grids::make().
vtkSmartPointer<vtkUnstructuredGrid> piece(
  const morph::distributed::Ranks& ranks, const morph::Mesh& whole, unsigned seed);
/// The same, of a grid with further arrays.
vtkSmartPointer<vtkUnstructuredGrid> piece(const morph::distributed::Ranks& ranks,
  vtkUnstructuredGrid* whole, const morph::Mesh& mesh, unsigned seed);

/// Calls `work` with each rank by itself, as without MPI.
void alone(const std::function<void()>& work);
}
