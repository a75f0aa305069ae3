// SPDX-License-Identifier: BSD-3-Clause
#include "vtkExtractMorphBoundary.h"

#include "Mesh/Topology.h"
#include "vtkMorphExecution.h"
#include "vtkMorphInput.h"
#include "vtkMorphMesh.h"
#include "vtkMorphMonitor.h"
#include "vtkMorphSurface.h"

#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <string>

vtkStandardNewMacro(vtkExtractMorphBoundary);

vtkExtractMorphBoundary::vtkExtractMorphBoundary() = default;
vtkExtractMorphBoundary::~vtkExtractMorphBoundary() = default;

int vtkExtractMorphBoundary::FillInputPortInformation(int, vtkInformation* info)
{
  // Any other type would make the executive run the filter block by block; see vtkMorphInput.h.
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataObject");
  return 1;
}

int vtkExtractMorphBoundary::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkDataObject* input = vtkDataObject::GetData(inputVector[0]);
  vtkPolyData* output = vtkPolyData::GetData(outputVector);
  vtkMorphMonitor monitor(this, this->NumberOfThreads);
  const auto extract = [&]
  {
    auto* grid = vtkUnstructuredGrid::SafeDownCast(input);
    const int ranksWithCells = vtkMorphInput::RequireOneRankWithCells(grid);
    grid = vtkMorphInput::RequireGrid(input, "The input");
    if (ranksWithCells == 0 || grid->GetNumberOfCells() > 0)
    {
      this->Extract(grid, output, monitor);
    }
  };
  vtkMorphExecution::Run(
    this, "extract this mesh's boundary", extract, [&] { output->Initialize(); });
  for (const std::string& warning : monitor.TakeWarnings())
  {
    vtkWarningMacro(<< warning);
  }
  return 1;
}

void vtkExtractMorphBoundary::Extract(
  vtkUnstructuredGrid* grid, vtkPolyData* output, vtkMorphMonitor& monitor)
{
  const morph::Mesh mesh = vtkMorphMesh::FromGrid(grid);
  vtkMorphInput::RequireVolumeCells(mesh);
  monitor.progress(0.2);
  const morph::BoundaryFaces faces = morph::boundaryFaces(mesh, monitor);
  monitor.progress(0.6);
  monitor.check();
  vtkMorphSurface::WarnOfNone(faces, monitor);
  vtkMorphSurface::Write(grid, mesh, faces, output);
}

void vtkExtractMorphBoundary::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
}
