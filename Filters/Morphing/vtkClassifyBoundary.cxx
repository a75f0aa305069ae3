// SPDX-License-Identifier: BSD-3-Clause
#include "vtkClassifyBoundary.h"

#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"
#include "Private/Blocks/Blocks.h"
#include "Private/Data/Geometry.h"
#include "Private/Data/GridMesh.h"
#include "Private/Data/Surface.h"
#include "Private/Distributed/WholeSurface.h"
#include "Private/Options.h"
#include "Private/Pipeline/Execution.h"
#include "Private/Pipeline/Input.h"
#include "Private/Pipeline/Monitor.h"
#include "Private/Pipeline/Ports.h"
#include "Private/Pipeline/Ranks.h"
#include "Support/Lists.h"
#include "Support/Monitor.h"

#include <vtkDataObject.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace filters = morph::filters;

vtkStandardNewMacro(vtkClassifyBoundary);

class vtkClassifyBoundary::vtkInternals
{
public:
  filters::Blocks Blocks;
  std::unique_ptr<filters::WholeSurface> Whole; ///< of a mesh on several MPI ranks, or null

  static filters::Geometry::Options Options(const vtkClassifyBoundary* filter);
  /// Fills the ports of the boundary. `orientation`: as for Surface::Write().
  static void Write(vtkClassifyBoundary* filter, vtkUnstructuredGrid* grid, const morph::Mesh& mesh,
    const morph::BoundaryFaces& faces, const morph::Classification& geometry,
    vtkInformationVector* outputVector, const std::vector<std::int8_t>* orientation = nullptr);
  void ClassifyOnRanks(vtkClassifyBoundary* filter, vtkUnstructuredGrid* piece,
    vtkInformationVector* outputVector, morph::Monitor& monitor);
};

namespace
{
/// The geometry where each body has a node of its own behind the boundary's, and then no body.
morph::Classification withBodies(morph::Classification geometry, morph::Index bodies)
{
  for (morph::Index body = 0; body <= bodies; ++body)
  {
    const bool isNone = body == bodies;
    geometry.dimension.push_back(isNone ? -1 : 3);
    geometry.entity.push_back(isNone ? -1 : body);
    geometry.parameter.push_back(0);
  }
  return geometry;
}
}

vtkClassifyBoundary::vtkClassifyBoundary()
  : Internals(new vtkInternals)
  , Options(std::make_unique<morph::ClassifyBoundaryOptions>())
{
  this->SetNumberOfOutputPorts(3);
}

vtkClassifyBoundary::~vtkClassifyBoundary() = default;

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
  filters::Monitor monitor(this, this->Options->NumberOfThreads);
  this->Clear(outputVector);
  const auto classify = [&]
  {
    const filters::Input::Mesh mesh = filters::Input::TakeMesh(input, this->Internals->Blocks,
      this->Options->CoincidentPoints, filters::Input::Use::ToMorph, this->GetClassName(), monitor);
    vtkUnstructuredGrid* grid = nullptr;
    filters::RankGroup(mesh.IsDistributed)
      .Together([&] { grid = filters::Input::RequireGrid(mesh.Data, "The input"); });
    if (mesh.IsDistributed)
    {
      this->Internals->ClassifyOnRanks(this, grid, outputVector, monitor);
      return;
    }
    this->Internals->Whole.reset();
    if (!mesh.IsElsewhere)
    {
      this->Classify(grid, outputVector, monitor);
    }
  };
  filters::Execution::Run(
    this, "classify this mesh's boundary", classify, [&] { this->Clear(outputVector); });
  if (!this->Internals->Whole || filters::Ranks::IsFirst())
  {
    monitor.TellWarnings();
  }
  this->Internals->Blocks.Scatter(outputVector);
  return 1;
}

void vtkClassifyBoundary::Classify(
  vtkUnstructuredGrid* grid, vtkInformationVector* outputVector, morph::Monitor& monitor)
{
  const morph::Mesh mesh = filters::GridMesh::FromGrid(grid);
  morph::requireVolumeCells(mesh);
  monitor.progress(0.1);
  const morph::BoundaryFaces faces = morph::boundaryFaces(mesh, monitor);
  filters::Surface::WarnOfNone(faces, monitor);

  morph::ProgressRange classifying(monitor, 0.3, 0.8);
  const morph::Classification geometry =
    filters::Geometry::Classify(grid, mesh, faces, vtkInternals::Options(this), classifying);
  monitor.check();

  vtkUnstructuredGrid* classified = this->Internals->Blocks.Output(outputVector);
  classified->ShallowCopy(grid);
  filters::Geometry::AddPointArrays(
    geometry, morph::consecutive(mesh.numberOfNodes()), classified->GetPointData());
  vtkInternals::Write(this, grid, mesh, faces, geometry, outputVector);
}

filters::Geometry::Options vtkClassifyBoundary::vtkInternals::Options(
  const vtkClassifyBoundary* filter)
{
  filters::Geometry::Options options;
  options.Take(*filter->Options);
  options.FeaturesInside = filter->Options->FeaturesInside;
  return options;
}

void vtkClassifyBoundary::vtkInternals::Write(vtkClassifyBoundary* filter,
  vtkUnstructuredGrid* grid, const morph::Mesh& mesh, const morph::BoundaryFaces& faces,
  const morph::Classification& geometry, vtkInformationVector* outputVector,
  const std::vector<std::int8_t>* orientation)
{
  auto* surfaces = vtkPolyData::GetData(outputVector, 1);
  const std::vector<morph::Index> faceOf =
    filters::Surface::Write(grid, mesh, faces, surfaces, orientation);
  filters::Geometry::AddPointArrays(geometry, faces.nodes, surfaces->GetPointData());
  filters::Geometry::AddSurfaceIds(geometry, faceOf, surfaces);

  filters::Geometry::WriteCurves(grid, geometry, vtkPolyData::GetData(outputVector, 2));
  filter->NumberOfVertices = static_cast<vtkIdType>(geometry.vertices.size());
  filter->NumberOfCurves = static_cast<vtkIdType>(geometry.curves.size());
  filter->NumberOfSurfaces = static_cast<vtkIdType>(geometry.surfaces.size());
}

/// The whole boundary on each process, of which each keeps the surfaces and curves of its cells.
void vtkClassifyBoundary::vtkInternals::ClassifyOnRanks(vtkClassifyBoundary* filter,
  vtkUnstructuredGrid* piece, vtkInformationVector* outputVector, morph::Monitor& monitor)
{
  if (!this->Whole)
  {
    this->Whole = filters::WholeSurface::Make();
  }
  filters::WholeSurface& whole = *this->Whole;
  whole.Take(piece, monitor);
  const filters::GatheredSurface& all = whole.Boundary();
  whole.Together(
    [&]
    {
      filters::Surface::WarnOfNone(all.Faces, monitor);
      morph::ProgressRange classifying(monitor, 0.3, 0.8);
      morph::Classification geometry =
        filters::Geometry::Classify(all.Grid, all.Shell, all.Faces, Options(filter), classifying);
      monitor.check();
      Write(filter, all.Grid, all.Shell, all.Faces, geometry, outputVector, &all.Orientation);
      whole.KeepOwn(vtkPolyData::GetData(outputVector, 1));
      whole.KeepOwn(vtkPolyData::GetData(outputVector, 2));
      vtkUnstructuredGrid* classified = this->Blocks.Output(outputVector);
      classified->ShallowCopy(piece);
      filters::Geometry::AddPointArrays(
        withBodies(std::move(geometry), static_cast<morph::Index>(all.NumberOfBody.size())),
        whole.Places(), classified->GetPointData());
    });
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
  this->PrintOptions(os, indent);
  os << indent << "NumberOfVertices: " << this->NumberOfVertices << "\n";
  os << indent << "NumberOfCurves: " << this->NumberOfCurves << "\n";
  os << indent << "NumberOfSurfaces: " << this->NumberOfSurfaces << "\n";
}
