// SPDX-License-Identifier: BSD-3-Clause
#include "vtkExtractMorphBoundary.h"

#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"
#include "Private/Blocks/Blocks.h"
#include "Private/Data/GridMesh.h"
#include "Private/Data/Surface.h"
#include "Private/Distributed/OnRanks.h"
#include "Private/Options.h"
#include "Private/Pipeline/Execution.h"
#include "Private/Pipeline/Input.h"
#include "Private/Pipeline/Monitor.h"
#include "Private/Pipeline/Ranks.h"

#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <string>

namespace filters = morph::filters;

vtkStandardNewMacro(vtkExtractMorphBoundary);

class vtkExtractMorphBoundary::vtkInternals
{
public:
  filters::Blocks Blocks;
};

vtkExtractMorphBoundary::vtkExtractMorphBoundary()
  : Internals(new vtkInternals)
  , Options(std::make_unique<morph::ExtractMorphBoundaryOptions>())
{
}

vtkExtractMorphBoundary::~vtkExtractMorphBoundary() = default;

int vtkExtractMorphBoundary::FillInputPortInformation(int, vtkInformation* info)
{
  // Any other type would make the executive run the filter block by block; see filters::Input.h.
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataObject");
  return 1;
}

int vtkExtractMorphBoundary::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkDataObject* input = vtkDataObject::GetData(inputVector[0]);
  vtkPolyData* output = vtkPolyData::GetData(outputVector);
  filters::Monitor monitor(this, this->Options->NumberOfThreads);
  const auto extract = [&]
  {
    const filters::Input::Mesh mesh = filters::Input::TakeMesh(input, this->Internals->Blocks,
      this->Options->CoincidentPoints, filters::Input::Use::ToMorph, this->GetClassName(), monitor);
    vtkUnstructuredGrid* grid = nullptr;
    filters::RankGroup(mesh.IsDistributed)
      .Together([&] { grid = filters::Input::RequireGrid(mesh.Data, "The input"); });
    if (mesh.IsDistributed)
    {
      filters::OnRanks::ExtractBoundary(grid, output, monitor);
    }
    else if (!mesh.IsElsewhere)
    {
      this->Extract(grid, output, monitor);
    }
  };
  filters::Execution::Run(
    this, "extract this mesh's boundary", extract, [&] { output->Initialize(); });
  monitor.TellWarnings();
  return 1;
}

void vtkExtractMorphBoundary::Extract(
  vtkUnstructuredGrid* grid, vtkPolyData* output, morph::Monitor& monitor)
{
  const morph::Mesh mesh = filters::GridMesh::FromGrid(grid);
  morph::requireVolumeCells(mesh);
  monitor.progress(0.2);
  const morph::BoundaryFaces faces = morph::boundaryFaces(mesh, monitor);
  monitor.progress(0.6);
  monitor.check();
  filters::Surface::WarnOfNone(faces, monitor);
  filters::Surface::Write(grid, mesh, faces, output);
}
