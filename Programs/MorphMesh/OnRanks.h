// SPDX-License-Identifier: BSD-3-Clause
#pragma once

class vtkMorphAlgorithm;

namespace morph_mesh
{
struct Arguments;

/// The number of processes that mpiexec has started, 1 without it.
int numberOfRanks();

/// Morphs the pieces of a .pvtu on the MPI ranks that mpiexec has started, some on each. `filter`:
/// with its options. Returns the exit status, the same on all ranks; the first rank prints. Throws
/// UsageError for what needs one rank.
int morphOnRanks(vtkMorphAlgorithm* filter, const Arguments& arguments);
}
