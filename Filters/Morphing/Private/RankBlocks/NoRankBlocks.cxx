// SPDX-License-Identifier: BSD-3-Clause
// A build without MPI or hypre: Input::TakeMesh() does not merge blocks on several ranks.
#include "Private/RankBlocks/RankBlocks.h"

#include <stdexcept>

namespace morph::filters::RankBlocks
{
MergedBlocks Make(vtkDataObjectTree*, MergedBlocks::Options)
{
  throw std::logic_error("This build has no MPI.");
}
}
