// SPDX-License-Identifier: BSD-3-Clause
// A build without MPI or hypre: Input::TakeMesh() refuses meshes on several ranks before any of
// this.
#include "Private/Distributed/OnRanks.h"
#include "Private/Distributed/WholeSurface.h"
#include "Private/RankBlocks/RankBlocks.h"

#include <stdexcept>

namespace morph::filters
{
namespace
{
[[noreturn]] void refuse()
{
  throw std::logic_error("This build has no MPI.");
}
}

std::unique_ptr<WholeSurface> WholeSurface::Make()
{
  refuse();
}

MergedBlocks RankBlocks::Make(vtkDataObjectTree*, MergedBlocks::Options)
{
  refuse();
}

std::unique_ptr<OnRanks::Morphing> OnRanks::MakeMorphing(Results&, morph::Session&)
{
  refuse();
}

std::unique_ptr<ModeSolver> OnRanks::MakeModeSolver()
{
  refuse();
}

void OnRanks::ExtractBoundary(vtkUnstructuredGrid*, vtkPolyData*, morph::Monitor&)
{
  refuse();
}

OnRanks::Measured OnRanks::Measure(vtkUnstructuredGrid*, bool, std::vector<Quality::OfCriterion>&,
  vtkUnstructuredGrid*, morph::Monitor&)
{
  refuse();
}
}
