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

ShellGrid::Solid RankBlocks::Thicken(vtkUnstructuredGrid*)
{
  refuse();
}

std::unique_ptr<KeptMesh> OnRanks::MakeMesh()
{
  refuse();
}

void OnRanks::ExtractBoundary(vtkUnstructuredGrid*, vtkPolyData*, morph::Monitor&)
{
  refuse();
}

std::pair<Quality::Measured, morph::Index> OnRanks::Measure(vtkUnstructuredGrid*, bool,
  std::vector<Quality::OfCriterion>&, vtkUnstructuredGrid*, morph::Monitor&)
{
  refuse();
}
}
