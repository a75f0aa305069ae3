// SPDX-License-Identifier: BSD-3-Clause
// A build without MPI or hypre.
#include "Arguments.h"
#include "OnRanks.h"

namespace morph_mesh
{
int morphOnRanks(vtkMorphAlgorithm*, const Arguments&)
{
  throw UsageError("morph-mesh needs one MPI rank, and mpiexec has started " +
                   std::to_string(numberOfRanks()) + ": it was built without MPI or hypre.");
}
}
