// SPDX-License-Identifier: BSD-3-Clause
#include "vtkExtractMorphBoundary.h"

#include "Topology.h"
#include "vtkMorphBoundaryMatch.h"
#include "vtkMorphExecution.h"
#include "vtkMorphFaces.h"
#include "vtkMorphInput.h"
#include "vtkMorphMesh.h"
#include "vtkMorphMonitor.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkIdTypeArray.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <map>

vtkStandardNewMacro(vtkExtractMorphBoundary);

namespace
{
/// The pieces of each face of each cell type, made when first asked for.
class FacePieces
{
public:
  /// Those of boundary face `face`.
  const std::vector<vtkMorphFaces::Polygon>& Of(
    const morph::Mesh& mesh, const morph::BoundaryFaces& faces, morph::Index face)
  {
    const morph::Index cell = faces.cells[face];
    const morph::CellShape& shape = *morph::cellShape(mesh.types[cell]);
    auto& pieces = this->ByType[mesh.types[cell]];
    if (pieces.empty())
    {
      for (int f = 0; f < shape.numberOfFaces; ++f)
      {
        pieces.push_back(vtkMorphFaces::Pieces(shape, f));
      }
    }
    return pieces[faces.sides[face]];
  }

private:
  std::map<std::uint8_t, std::vector<std::vector<vtkMorphFaces::Polygon>>> ByType;
};

void writePoints(
  vtkUnstructuredGrid* grid, const std::vector<morph::Index>& nodes, vtkPolyData* output)
{
  const vtkIdType count = static_cast<vtkIdType>(nodes.size());
  vtkNew<vtkPoints> points;
  points->SetDataType(grid->GetPoints()->GetDataType());
  points->SetNumberOfPoints(count);
  vtkNew<vtkIdTypeArray> ids;
  ids->SetName(vtkMorphBoundaryMatch::IdName);
  ids->SetNumberOfValues(count);
  vtkNew<vtkDoubleArray> rest;
  rest->SetName(vtkMorphBoundaryMatch::RestName);
  rest->SetNumberOfComponents(4);
  rest->SetNumberOfTuples(count);
  const char* components[] = { "X", "Y", "Z", "W" };
  for (int j = 0; j < 4; ++j)
  {
    rest->SetComponentName(j, components[j]);
  }

  vtkPointData* from = grid->GetPointData();
  vtkPointData* to = output->GetPointData();
  to->CopyGlobalIdsOn();
  to->CopyPedigreeIdsOn();
  to->CopyAllocate(from, count);
  for (vtkIdType i = 0; i < count; ++i)
  {
    double x[4] = { 0, 0, 0, 1 };
    grid->GetPoint(nodes[i], x);
    points->SetPoint(i, x);
    ids->SetValue(i, nodes[i]);
    rest->SetTypedTuple(i, x);
    to->CopyData(from, nodes[i], i);
  }
  to->AddArray(ids);
  to->AddArray(rest);
  output->SetPoints(points);
}

void writePolygons(vtkUnstructuredGrid* grid, const morph::Mesh& mesh,
  const morph::BoundaryFaces& faces, vtkPolyData* output)
{
  std::vector<vtkIdType> number(mesh.numberOfNodes(), -1);
  for (std::size_t i = 0; i < faces.nodes.size(); ++i)
  {
    number[faces.nodes[i]] = static_cast<vtkIdType>(i);
  }
  const std::vector<std::int8_t> orientation = morph::orientation(mesh, morph::bodies(mesh));

  vtkNew<vtkCellArray> polygons;
  vtkNew<vtkIdTypeArray> owners;
  owners->SetName("MorphCellId");
  vtkCellData* from = grid->GetCellData();
  vtkCellData* to = output->GetCellData();
  to->CopyGlobalIdsOff();
  to->CopyAllocate(from, static_cast<vtkIdType>(faces.cells.size()));

  FacePieces pieces;
  std::vector<vtkIdType> points;
  for (std::size_t face = 0; face < faces.cells.size(); ++face)
  {
    const morph::Index owner = faces.cells[face];
    for (const auto& polygon : pieces.Of(mesh, faces, static_cast<morph::Index>(face)))
    {
      points.clear();
      for (int place : polygon)
      {
        points.push_back(number[mesh.cell(owner)[place]]);
      }
      // A collapsed cell repeats nodes.
      points.erase(std::unique(points.begin(), points.end()), points.end());
      if (points.size() > 1 && points.front() == points.back())
      {
        points.pop_back();
      }
      if (points.size() < 3)
      {
        continue;
      }
      if (orientation[owner] < 0)
      {
        std::reverse(points.begin(), points.end());
      }
      const vtkIdType cell =
        polygons->InsertNextCell(static_cast<vtkIdType>(points.size()), points.data());
      owners->InsertNextValue(owner);
      to->CopyData(from, owner, cell);
    }
  }
  to->AddArray(owners);
  output->SetPolys(polygons);
}
}

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
  const auto extract = [&]
  {
    auto* grid = vtkUnstructuredGrid::SafeDownCast(input);
    const int ranksWithCells = vtkMorphInput::RequireOneRankWithCells(grid);
    grid = vtkMorphInput::RequireGrid(input, "The input");
    if (ranksWithCells == 0 || grid->GetNumberOfCells() > 0)
    {
      this->Extract(grid, output);
    }
  };
  return vtkMorphExecution::Run(
    this, "extract this mesh's boundary", extract, [&] { output->Initialize(); });
}

void vtkExtractMorphBoundary::Extract(vtkUnstructuredGrid* grid, vtkPolyData* output)
{
  vtkMorphMonitor monitor(this, this->NumberOfThreads);
  const morph::Mesh mesh = vtkMorphMesh::FromGrid(grid);
  vtkMorphInput::RequireVolumeCells(mesh);
  monitor.progress(0.2);
  const morph::BoundaryFaces faces = morph::boundaryFaces(mesh, monitor);
  monitor.progress(0.6);
  monitor.check();
  writePoints(grid, faces.nodes, output);
  writePolygons(grid, mesh, faces, output);
}

void vtkExtractMorphBoundary::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
}
