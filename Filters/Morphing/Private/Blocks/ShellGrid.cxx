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
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <vector>

namespace morph::filters
{
namespace
{
void insertCells(const morph::Mesh& mesh, vtkUnstructuredGrid* grid)
{
  grid->AllocateExact(mesh.numberOfCells(), static_cast<vtkIdType>(mesh.connectivity.size()));
  std::vector<vtkIdType> corners;
  for (morph::Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    corners.assign(mesh.cell(c), mesh.cell(c) + mesh.cellSize(c));
    grid->InsertNextCell(mesh.types[c], mesh.cellSize(c), corners.data());
  }
}

/// `mesh` with all arrays of `from`, whose points are mesh.layer's and whose cells are the mesh's.
vtkSmartPointer<vtkUnstructuredGrid> solidOf(const morph::Mesh& mesh, vtkUnstructuredGrid* from)
{
  const vtkIdType front = from->GetNumberOfPoints(), nodes = mesh.numberOfNodes();
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  auto points = Arrays::MakePoints(from->GetPoints()->GetDataType(), nodes);
  for (vtkIdType i = 0; i < nodes; ++i)
  {
    points->SetPoint(i, mesh.points.row(i).data());
  }
  grid->SetPoints(points);
  insertCells(mesh, grid);
  std::vector<vtkIdType> image(nodes);
  for (vtkIdType i = 0; i < 2 * front; ++i)
  {
    image[i] = i % front;
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
  vtkPointData* arrays = grid->GetPointData();
  arrays->CopyGlobalIdsOff();
  arrays->CopyAllocate(from->GetPointData(), nodes);
  for (vtkIdType i = 0; i < nodes; ++i)
  {
    arrays->CopyData(from->GetPointData(), image[i], i);
  }
  grid->GetCellData()->ShallowCopy(from->GetCellData());
  grid->GetFieldData()->ShallowCopy(from->GetFieldData());
  GridMesh::MarkLayer(mesh.layer, grid);
  return grid;
}

/// Polygonal data as a grid.
vtkSmartPointer<vtkUnstructuredGrid> gridOf(vtkPolyData* surface)
{
  const morph::Mesh mesh = BlockCells::Read(surface, "The input", GridMesh::UnknownCells::Refuse);
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  grid->SetPoints(surface->GetPoints());
  insertCells(mesh, grid);
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

vtkDataObject* ShellGrid::Thicken(vtkDataObject* input)
{
  auto* grid = vtkUnstructuredGrid::SafeDownCast(input);
  auto* surface = vtkPolyData::SafeDownCast(input);
  const bool isKept =
    grid ? this->Seen.Is(grid)
         : surface && surface == this->Input && surface->GetMTime() == this->InputTime;
  if (this->Thick && isKept)
  {
    return this->Thick;
  }
  *this = ShellGrid();
  if (!IsShell(input))
  {
    return input;
  }
  vtkSmartPointer<vtkUnstructuredGrid> flat = grid;
  if (surface)
  {
    flat = gridOf(surface);
  }
  const morph::Mesh plane = BlockCells::Read(flat, "The input", GridMesh::UnknownCells::Refuse);
  this->Thick = solidOf(morph::thicken(plane), flat);
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
  GridMesh::MarkLayer({}, output);
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
