// SPDX-License-Identifier: BSD-3-Clause
// A build without MPI or hypre: Input::TakeMesh() refuses meshes on several ranks before this.
#include "Private/Distributed/OnRanks.h"

#include <stdexcept>

namespace morph::filters::OnRanks
{
namespace
{
[[noreturn]] void refuse()
{
  throw std::logic_error("This build has no MPI.");
}
}

class Morphing::Internals
{
};

Morphing::Morphing(Results&)
{
}

Morphing::~Morphing() = default;

std::string Morphing::Run(const Task&, const MotionOptions&, morph::Monitor&)
{
  refuse();
}

void Morphing::CheckSeries(vtkMTimeType, bool, vtkMTimeType)
{
}

void Morphing::Transpose(vtkUnstructuredGrid*, vtkDataObject*, vtkDataArray*, const MotionOptions&,
  vtkDoubleArray*, morph::Monitor&)
{
  refuse();
}

void Morphing::WriteUndeformedSurface(vtkUnstructuredGrid*, vtkPolyData*) const
{
}

std::unique_ptr<ModeSolver> MakeModeSolver()
{
  refuse();
}

void ExtractBoundary(vtkUnstructuredGrid*, vtkPolyData*, morph::Monitor&)
{
  refuse();
}

Measured Measure(vtkUnstructuredGrid*, bool, std::vector<Quality::OfCriterion>&,
  vtkUnstructuredGrid*, morph::Monitor&)
{
  refuse();
}
}
