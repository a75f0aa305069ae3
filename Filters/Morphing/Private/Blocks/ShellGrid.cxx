// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Blocks/ShellGrid.h"

#include "Mesh/CellShape.h"
#include "Mesh/ShellLayer.h"
#include "Private/Blocks/BlockCells.h"
#include "Private/Data/Arrays.h"
#include "Private/Data/GridMesh.h"
#include "Private/Data/SubGrid.h"
#include "Private/Data/Surface.h"
#include "Support/Lists.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <vector>

namespace morph::filters
{
namespace
{
/// The first `count` cells.
void insertCells(const morph::Mesh& mesh, vtkIdType count, vtkUnstructuredGrid* grid)
{
  grid->AllocateExact(count, mesh.offsets[count]);
  std::vector<vtkIdType> corners;
  for (vtkIdType c = 0; c < count; ++c)
  {
    corners.assign(mesh.cell(c), mesh.cell(c) + mesh.cellSize(c));
    grid->InsertNextCell(mesh.types[c], mesh.cellSize(c), corners.data());
  }
}

/// Of each node of a layer that of the front that it is behind.
std::vector<vtkIdType> imagesOf(const morph::Mesh& mesh)
{
  std::vector<vtkIdType> image(mesh.numberOfNodes());
  for (morph::Index i = 0; i < 2 * mesh.layer.nodes; ++i)
  {
    image[i] = i % mesh.layer.nodes;
  }
  for (morph::Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const morph::CellShape& shape = *morph::cellShape(mesh.types[c]);
    // Nodes between front and back are the last ones of a cell, in the order of its corners.
    const bool hasMiddles = shape.dimension == 3 && mesh.cellSize(c) > shape.numberOfCorners;
    for (int k = 1; hasMiddles && 2 * k <= shape.numberOfCorners; ++k)
    {
      image[mesh.cell(c)[mesh.cellSize(c) - k]] = mesh.cell(c)[shape.numberOfCorners / 2 - k];
    }
  }
  return image;
}

/// The solid with all arrays of `from`, whose points and cells are the first ones of its front.
vtkSmartPointer<vtkUnstructuredGrid> gridOf(
  const ShellGrid::Solid& solid, vtkUnstructuredGrid* from)
{
  const morph::Mesh& mesh = solid.Mesh;
  const vtkIdType own = from->GetNumberOfPoints(), nodes = mesh.numberOfNodes();
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  auto points = Arrays::MakePoints(own > 0 ? from->GetPoints()->GetDataType() : VTK_FLOAT, nodes);
  for (vtkIdType i = 0; i < nodes; ++i)
  {
    points->SetPoint(i, mesh.points.row(i).data());
  }
  grid->SetPoints(points);
  insertCells(mesh, from->GetNumberOfCells(), grid);
  const std::vector<vtkIdType> image = imagesOf(mesh);
  vtkPointData* arrays = grid->GetPointData();
  arrays->CopyGlobalIdsOff();
  arrays->CopyAllocate(from->GetPointData(), nodes);
  for (vtkIdType i = 0; i < nodes; ++i)
  {
    image[i] < own ? arrays->CopyData(from->GetPointData(), image[i], i) : arrays->NullData(i);
  }
  grid->GetCellData()->ShallowCopy(from->GetCellData());
  grid->GetFieldData()->ShallowCopy(from->GetFieldData());
  if (!solid.FrontIds.empty())
  {
    auto ids = Arrays::Make<vtkIdTypeArray>("MorphGlobalPointId", nodes);
    for (vtkIdType i = 0; i < nodes; ++i)
    {
      const vtkIdType behind = std::min<vtkIdType>(2, i / mesh.layer.nodes);
      ids->SetValue(i, solid.FrontIds[image[i]] + behind * solid.NextId);
    }
    arrays->SetGlobalIds(ids);
  }
  GridMesh::MarkLayer(mesh.layer, own, grid);
  return grid;
}

/// Polygonal data as a grid.
vtkSmartPointer<vtkUnstructuredGrid> gridOf(vtkPolyData* surface)
{
  const morph::Mesh mesh = BlockCells::Read(surface, "The input", GridMesh::UnknownCells::Refuse);
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  grid->SetPoints(surface->GetPoints());
  insertCells(mesh, mesh.numberOfCells(), grid);
  grid->GetPointData()->ShallowCopy(surface->GetPointData());
  grid->GetCellData()->ShallowCopy(surface->GetCellData());
  grid->GetFieldData()->ShallowCopy(surface->GetFieldData());
  return grid;
}

/// Appends what the faces of a solid have of its `front`, in their order.
void insertEdges(vtkUnstructuredGrid* faces, vtkIdType front, vtkUnstructuredGrid* to)
{
  to->Allocate(faces->GetNumberOfCells());
  vtkNew<vtkIdList> corners, ends;
  for (vtkIdType face = 0; face < faces->GetNumberOfCells(); ++face)
  {
    faces->GetCellPoints(face, corners);
    ends->Reset();
    for (vtkIdType i = 0; i < corners->GetNumberOfIds(); ++i)
    {
      if (corners->GetId(i) < front)
      {
        ends->InsertNextId(corners->GetId(i));
      }
    }
    to->InsertNextCell(ends->GetNumberOfIds() == 2 ? VTK_LINE : VTK_POLY_VERTEX, ends);
  }
}

/// Gives `to` these points of `from`, and their arrays.
void copyPoints(
  vtkUnstructuredGrid* from, const std::vector<vtkIdType>& ids, vtkUnstructuredGrid* to)
{
  const auto count = static_cast<vtkIdType>(ids.size());
  auto points = Arrays::MakePoints(from->GetPoints()->GetDataType(), count);
  vtkPointData* arrays = to->GetPointData();
  arrays->Initialize();
  arrays->CopyAllocate(from->GetPointData(), count);
  for (vtkIdType i = 0; i < count; ++i)
  {
    points->SetPoint(i, from->GetPoint(ids[i]));
    arrays->CopyData(from->GetPointData(), ids[i], i);
  }
  to->SetPoints(points);
}

/// A boundary that a filter of this module made has its nodes' ids.
bool isExtracted(vtkPolyData* surface)
{
  return surface->GetPointData()->GetAbstractArray(Surface::IdName);
}
}

bool ShellGrid::IsShell(vtkDataObject* input)
{
  auto* surface = vtkPolyData::SafeDownCast(input);
  const bool isGrid = vtkUnstructuredGrid::SafeDownCast(input);
  return (isGrid || (surface && !isExtracted(surface))) &&
         BlockCells::Dimension(vtkDataSet::SafeDownCast(input)) == 2;
}

bool ShellGrid::IsKept(vtkDataObject* input, bool areOnRanks) const
{
  auto* grid = vtkUnstructuredGrid::SafeDownCast(input);
  const bool isSame = grid ? this->Seen.Is(grid)
                           : input && input == this->Input && input->GetMTime() == this->InputTime;
  return this->Thick && isSame &&
         (this->Thick->GetPointData()->GetGlobalIds() != nullptr) == areOnRanks;
}

vtkDataObject* ShellGrid::Kept() const
{
  return this->Thick;
}

vtkDataObject* ShellGrid::Thicken(vtkDataObject* input)
{
  if (this->IsKept(input, false))
  {
    return this->Thick;
  }
  *this = ShellGrid();
  if (!IsShell(input))
  {
    return input;
  }
  const auto make = [](vtkUnstructuredGrid* flat)
  {
    const auto unknown = GridMesh::UnknownCells::Refuse;
    return Solid{ morph::thicken(BlockCells::Read(flat, "The input", unknown)), {} };
  };
  return this->ThickenBy(make, input);
}

vtkDataObject* ShellGrid::ThickenBy(
  const std::function<Solid(vtkUnstructuredGrid* flat)>& make, vtkDataObject* input)
{
  *this = ShellGrid();
  auto* grid = vtkUnstructuredGrid::SafeDownCast(input);
  auto* surface = vtkPolyData::SafeDownCast(input);
  vtkSmartPointer<vtkUnstructuredGrid> flat = grid;
  if (!grid)
  {
    flat = surface ? gridOf(surface) : vtkSmartPointer<vtkUnstructuredGrid>::New();
  }
  const Solid solid = make(flat);
  if (!grid && !surface)
  {
    return input; // of another type, or nothing: the caller refuses it
  }
  this->Thick = gridOf(solid, flat);
  this->Flat = flat;
  if (grid)
  {
    this->Seen.See(grid);
  }
  this->Input = surface;
  this->InputTime = input->GetMTime();
  return this->Thick;
}

void ShellGrid::Flatten(vtkUnstructuredGrid* output, bool withFaces) const
{
  GridMesh::MarkLayer({}, 0, output);
  const bool isOnSolid =
    this->Thick && output->GetNumberOfPoints() == this->Thick->GetNumberOfPoints();
  const bool areFaces = isOnSolid && output->GetCells() != this->Thick->GetCells();
  if (!isOnSolid || (areFaces && !withFaces))
  {
    return;
  }
  std::vector<vtkIdType> front = consecutive<vtkIdType>(this->Flat->GetNumberOfPoints());
  vtkNew<vtkUnstructuredGrid> flat;
  areFaces ? insertEdges(output, this->Flat->GetNumberOfPoints(), flat)
           : flat->ShallowCopy(this->Flat); // its cells
  copyPoints(output, front, flat);
  if (vtkDataArray* ids = this->Flat->GetPointData()->GetGlobalIds())
  {
    flat->GetPointData()->SetGlobalIds(ids);
  }
  flat->GetCellData()->ShallowCopy(output->GetCellData());
  flat->GetFieldData()->ShallowCopy(output->GetFieldData());
  output->ShallowCopy(flat);
}

void ShellGrid::FlattenCells(vtkUnstructuredGrid* cells) const
{
  vtkDataArray* nodes = cells ? cells->GetPointData()->GetArray("MorphPointId") : nullptr;
  vtkDataArray* ids = cells ? cells->GetCellData()->GetArray("MorphCellId") : nullptr;
  if (!this->Thick || !nodes || !ids)
  {
    return;
  }
  std::vector<vtkIdType> front, number(this->Flat->GetNumberOfPoints());
  for (vtkIdType i = 0; i < cells->GetNumberOfPoints(); ++i)
  {
    const auto node = static_cast<vtkIdType>(nodes->GetComponent(i, 0));
    if (node < this->Flat->GetNumberOfPoints())
    {
      number[node] = static_cast<vtkIdType>(front.size());
      front.push_back(i);
    }
  }
  vtkNew<vtkUnstructuredGrid> flat;
  flat->AllocateExact(cells->GetNumberOfCells(), 4 * cells->GetNumberOfCells());
  for (vtkIdType c = 0; c < cells->GetNumberOfCells(); ++c)
  {
    SubGrid::InsertCell(
      this->Flat, static_cast<vtkIdType>(ids->GetComponent(c, 0)),
      [&number](vtkIdType node) { return number[node]; }, flat);
  }
  copyPoints(cells, front, flat);
  flat->GetCellData()->ShallowCopy(cells->GetCellData());
  flat->GetFieldData()->ShallowCopy(cells->GetFieldData());
  cells->ShallowCopy(flat);
}
}
