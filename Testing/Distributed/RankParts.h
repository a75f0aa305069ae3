// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/Ranks.h"
#include "Mesh/Mesh.h"

#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

namespace rank_grids
{
/// This rank's cells of `whole` in a random partition, with its arrays and with global ids. `mesh`:
/// that it was made of.
vtkSmartPointer<vtkUnstructuredGrid> part(const morph::distributed::Ranks& ranks,
  vtkUnstructuredGrid* whole, const morph::Mesh& mesh, unsigned seed);
}
