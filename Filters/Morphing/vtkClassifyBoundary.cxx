// SPDX-License-Identifier: BSD-3-Clause
#include "vtkClassifyBoundary.h"

#include "Mesh/Topology.h"
#include "vtkMorphExecution.h"
#include "vtkMorphGeometry.h"
#include "vtkMorphInput.h"
#include "vtkMorphMesh.h"
#include "vtkMorphMonitor.h"
#include "vtkMorphProperty.h"
#include "vtkMorphSurface.h"

#include <vtkDataObject.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <numeric>

vtkStandardNewMacro(vtkClassifyBoundary);

vtkMorphSetNumberMacro(vtkClassifyBoundary, FeatureAngle, 0.0, 180.0)
  vtkMorphSetNumberMacro(vtkClassifyBoundary, CornerAngle, 0.0, 180.0)

    vtkClassifyBoundary::vtkClassifyBoundary()
{
  this->SetNumberOfOutputPorts(3);
}

vtkClassifyBoundary::~vtkClassifyBoundary()
{
  this->SetSurfaceIdArray(nullptr);
}

vtkPolyData* vtkClassifyBoundary::GetSurfaces()
{
  return vtkPolyData::SafeDownCast(this->GetOutputDataObject(1));
}

vtkPolyData* vtkClassifyBoundary::GetCurves()
{
  return vtkPolyData::SafeDownCast(this->GetOutputDataObject(2));
}

int vtkClassifyBoundary::FillInputPortInformation(int, vtkInformation* info)
{
  // Any other type would make the executive run the filter block by block; see vtkMorphInput.h.
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataObject");
  return 1;
}

int vtkClassifyBoundary::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkUnstructuredGrid" : "vtkPolyData");
  return 1;
}

int vtkClassifyBoundary::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkDataObject* input = vtkDataObject::GetData(inputVector[0]);
  vtkMorphMonitor monitor(this, this->NumberOfThreads);
  this->Clear(outputVector);
  const auto classify = [&]
  {
    auto* grid = vtkUnstructuredGrid::SafeDownCast(input);
    const int ranksWithCells = vtkMorphInput::RequireOneRankWithCells(grid);
    grid = vtkMorphInput::RequireGrid(input, "The input");
    if (ranksWithCells == 0 || grid->GetNumberOfCells() > 0)
    {
      this->Classify(grid, outputVector, monitor);
    }
  };
  vtkMorphExecution::Run(
    this, "classify this mesh's boundary", classify, [&] { this->Clear(outputVector); });
  for (const std::string& warning : monitor.TakeWarnings())
  {
    vtkWarningMacro(<< warning);
  }
  return 1;
}

void vtkClassifyBoundary::Classify(
  vtkUnstructuredGrid* grid, vtkInformationVector* outputVector, vtkMorphMonitor& monitor)
{
  const morph::Mesh mesh = vtkMorphMesh::FromGrid(grid);
  vtkMorphInput::RequireVolumeCells(mesh);
  monitor.progress(0.1);
  const morph::BoundaryFaces faces = morph::boundaryFaces(mesh, monitor);
  vtkMorphSurface::WarnOfNone(faces, monitor);

  vtkMorphGeometry::Options options;
  options.FeatureAngle = this->FeatureAngle;
  options.CornerAngle = this->CornerAngle;
  options.FeaturesInside = this->FeaturesInside;
  options.SurfaceIdArray = vtkMorphInput::ArrayName(this->SurfaceIdArray);
  options.UseGeometryArrays = this->UseGeometryArrays;
  monitor.SetRange(0.3, 0.8);
  const morph::Classification geometry =
    vtkMorphGeometry::Classify(grid, mesh, faces, options, monitor);
  monitor.check();

  auto* classified = vtkUnstructuredGrid::GetData(outputVector, 0);
  classified->ShallowCopy(grid);
  std::vector<morph::Index> all(mesh.numberOfNodes());
  std::iota(all.begin(), all.end(), morph::Index(0));
  vtkMorphGeometry::AddPointArrays(geometry, all, classified->GetPointData());

  auto* surfaces = vtkPolyData::GetData(outputVector, 1);
  const std::vector<morph::Index> faceOf = vtkMorphSurface::Write(grid, mesh, faces, surfaces);
  vtkMorphGeometry::AddPointArrays(geometry, faces.nodes, surfaces->GetPointData());
  vtkMorphGeometry::AddSurfaceIds(geometry, faceOf, surfaces);

  vtkMorphGeometry::WriteCurves(grid, geometry, vtkPolyData::GetData(outputVector, 2));
  this->NumberOfVertices = static_cast<vtkIdType>(geometry.vertices.size());
  this->NumberOfCurves = static_cast<vtkIdType>(geometry.curves.size());
  this->NumberOfSurfaces = static_cast<vtkIdType>(geometry.surfaces.size());
}

void vtkClassifyBoundary::Clear(vtkInformationVector* outputVector)
{
  for (int port = 0; port < 3; ++port)
  {
    vtkDataObject::GetData(outputVector, port)->Initialize();
  }
  this->NumberOfVertices = this->NumberOfCurves = this->NumberOfSurfaces = 0;
}

void vtkClassifyBoundary::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FeatureAngle: " << this->FeatureAngle << "\n";
  os << indent << "CornerAngle: " << this->CornerAngle << "\n";
  os << indent << "SurfaceIdArray: " << (this->SurfaceIdArray ? this->SurfaceIdArray : "(none)")
     << "\n";
  os << indent << "UseGeometryArrays: " << this->UseGeometryArrays << "\n";
  os << indent << "FeaturesInside: " << this->FeaturesInside << "\n";
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
  os << indent << "NumberOfVertices: " << this->NumberOfVertices << "\n";
  os << indent << "NumberOfCurves: " << this->NumberOfCurves << "\n";
  os << indent << "NumberOfSurfaces: " << this->NumberOfSurfaces << "\n";
}
