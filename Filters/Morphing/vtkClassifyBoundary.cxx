// SPDX-License-Identifier: BSD-3-Clause
#include "vtkClassifyBoundary.h"

#include "Mesh/Topology.h"
#include "Private/Blocks/Blocks.h"
#include "Private/Data/Geometry.h"
#include "Private/Data/GridMesh.h"
#include "Private/Data/Surface.h"
#include "Private/Pipeline/Execution.h"
#include "Private/Pipeline/Input.h"
#include "Private/Pipeline/Monitor.h"
#include "Private/Pipeline/Ports.h"
#include "Private/Pipeline/Property.h"
#include "Support/ProgressRange.h"

#include <vtkDataObject.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <numeric>

namespace filters = morph::filters;

vtkStandardNewMacro(vtkClassifyBoundary);

class vtkClassifyBoundary::vtkInternals
{
public:
  filters::Blocks Blocks;
};

vtkClassifyBoundary::vtkClassifyBoundary()
  : Internals(new vtkInternals)
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

vtkTypeBool vtkClassifyBoundary::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  return filters::Ports::MakeOutput(request, inputVector, outputVector) ||
         this->Superclass::ProcessRequest(request, inputVector, outputVector);
}

int vtkClassifyBoundary::FillInputPortInformation(int, vtkInformation* info)
{
  // Any other type would make the executive run the filter block by block; see filters::Input.h.
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataObject");
  return 1;
}

int vtkClassifyBoundary::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkDataObject" : "vtkPolyData");
  return 1;
}

int vtkClassifyBoundary::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkDataObject* input = vtkDataObject::GetData(inputVector[0]);
  filters::Monitor monitor(this, this->NumberOfThreads);
  this->Clear(outputVector);
  const auto classify = [&]
  {
    const filters::Input::Mesh mesh = filters::Input::TakeMesh(input, this->Internals->Blocks,
      this->CoincidentPoints, filters::Input::Use::ToMorph, this->GetClassName(), monitor);
    vtkUnstructuredGrid* grid = filters::Input::RequireGrid(mesh.Data, "The input");
    if (!mesh.IsElsewhere)
    {
      this->Classify(grid, outputVector, monitor);
    }
  };
  filters::Execution::Run(
    this, "classify this mesh's boundary", classify, [&] { this->Clear(outputVector); });
  for (const std::string& warning : monitor.TakeWarnings())
  {
    vtkWarningMacro(<< warning);
  }
  this->Internals->Blocks.Scatter(outputVector);
  return 1;
}

void vtkClassifyBoundary::Classify(
  vtkUnstructuredGrid* grid, vtkInformationVector* outputVector, morph::Monitor& monitor)
{
  const morph::Mesh mesh = filters::GridMesh::FromGrid(grid);
  filters::Input::RequireVolumeCells(mesh);
  monitor.progress(0.1);
  const morph::BoundaryFaces faces = morph::boundaryFaces(mesh, monitor);
  filters::Surface::WarnOfNone(faces, monitor);

  filters::Geometry::Options options;
  options.FeatureAngle = this->FeatureAngle;
  options.CornerAngle = this->CornerAngle;
  options.FeaturesInside = this->FeaturesInside;
  options.SurfaceIdArray = filters::Input::ArrayName(this->SurfaceIdArray);
  options.UseGeometryArrays = this->UseGeometryArrays;
  morph::ProgressRange classifying(monitor, 0.3, 0.8);
  const morph::Classification geometry =
    filters::Geometry::Classify(grid, mesh, faces, options, classifying);
  monitor.check();

  vtkUnstructuredGrid* classified = this->Internals->Blocks.Output(outputVector);
  classified->ShallowCopy(grid);
  std::vector<morph::Index> all(mesh.numberOfNodes());
  std::iota(all.begin(), all.end(), morph::Index(0));
  filters::Geometry::AddPointArrays(geometry, all, classified->GetPointData());

  auto* surfaces = vtkPolyData::GetData(outputVector, 1);
  const std::vector<morph::Index> faceOf = filters::Surface::Write(grid, mesh, faces, surfaces);
  filters::Geometry::AddPointArrays(geometry, faces.nodes, surfaces->GetPointData());
  filters::Geometry::AddSurfaceIds(geometry, faceOf, surfaces);

  filters::Geometry::WriteCurves(grid, geometry, vtkPolyData::GetData(outputVector, 2));
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
  this->Internals->Blocks.Output(outputVector)->Initialize();
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
  os << indent << "CoincidentPoints: " << this->CoincidentPoints << "\n";
  os << indent << "NumberOfVertices: " << this->NumberOfVertices << "\n";
  os << indent << "NumberOfCurves: " << this->NumberOfCurves << "\n";
  os << indent << "NumberOfSurfaces: " << this->NumberOfSurfaces << "\n";
}

morphSetNumberMacro(vtkClassifyBoundary, FeatureAngle, 0.0, 180.0)
  morphSetNumberMacro(vtkClassifyBoundary, CornerAngle, 0.0, 180.0)
