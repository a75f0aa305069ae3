// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Blocks/PlaneGrid.h"

#include "Mesh/CellShape.h"
#include "Mesh/PlaneLayer.h"
#include "Private/Blocks/BlockCells.h"
#include "Private/Data/GridMesh.h"
#include "Private/Data/Surface.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <string>

namespace morph::filters
{
namespace
{
/// `mesh` with all arrays of `from`, whose points are mesh.layer's and whose cells are the mesh's.
vtkSmartPointer<vtkUnstructuredGrid> solidOf(const morph::Mesh& mesh, vtkUnstructuredGrid* from)
{
  const vtkIdType front = from->GetNumberOfPoints(), nodes = mesh.numberOfNodes();
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  points->SetDataType(from->GetPoints()->GetDataType());
  points->SetNumberOfPoints(nodes);
  for (vtkIdType i = 0; i < nodes; ++i)
  {
    points->SetPoint(i, mesh.points.row(i).data());
  }
  grid->SetPoints(points);
  grid->AllocateExact(mesh.numberOfCells(), static_cast<vtkIdType>(mesh.connectivity.size()));
  std::vector<vtkIdType> corners;
  for (morph::Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    corners.assign(mesh.cell(c), mesh.cell(c) + mesh.cellSize(c));
    grid->InsertNextCell(mesh.types[c], mesh.cellSize(c), corners.data());
  }
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
      image[mesh.cell(c)[mesh.cellSize(c) - k]] =
        mesh.cell(c)[shape.numberOfCorners / 2 - k];
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
  grid->AllocateExact(mesh.numberOfCells(), static_cast<vtkIdType>(mesh.connectivity.size()));
  std::vector<vtkIdType> corners;
  for (morph::Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    corners.assign(mesh.cell(c), mesh.cell(c) + mesh.cellSize(c));
    grid->InsertNextCell(mesh.types[c], mesh.cellSize(c), corners.data());
  }
  grid->GetPointData()->ShallowCopy(surface->GetPointData());
  grid->GetCellData()->ShallowCopy(surface->GetCellData());
  grid->GetFieldData()->ShallowCopy(surface->GetFieldData());
  return grid;
}

/// A boundary that a filter of this module made has its nodes' ids.
bool isExtracted(vtkPolyData* surface)
{
  return surface->GetPointData()->GetAbstractArray(Surface::IdName);
}
}

vtkDataObject* PlaneGrid::Thicken(vtkDataObject* input)
{
  auto* grid = vtkUnstructuredGrid::SafeDownCast(input);
  auto* surface = vtkPolyData::SafeDownCast(input);
  if (this->Thick && (grid ? this->Seen.Is(grid)
                           : input == this->Input && input->GetMTime() == this->InputTime))
  {
    return this->Thick;
  }
  *this = PlaneGrid();
  auto* block = static_cast<vtkDataSet*>(grid ? static_cast<vtkDataSet*>(grid) : surface);
  if (!block || (surface && isExtracted(surface)) || BlockCells::Dimension(block) != 2)
  {
    return input;
  }
  vtkSmartPointer<vtkUnstructuredGrid> flat = grid;
  if (surface)
  {
    flat = gridOf(surface);
  }
  const morph::Mesh plane =
    BlockCells::Read(flat, "The input", GridMesh::UnknownCells::Refuse);
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

void PlaneGrid::Flatten(vtkUnstructuredGrid* output) const
{
  GridMesh::MarkLayer({}, output);
  if (!this->Thick || output->GetNumberOfPoints() != this->Thick->GetNumberOfPoints() ||
      output->GetCells() != this->Thick->GetCells())
  {
    return;
  }
  const vtkIdType count = this->Flat->GetNumberOfPoints();
  vtkNew<vtkUnstructuredGrid> flat;
  flat->ShallowCopy(this->Flat); // its cells
  vtkNew<vtkPoints> points;
  points->SetDataType(output->GetPoints()->GetDataType());
  points->SetNumberOfPoints(count);
  for (vtkIdType i = 0; i < count; ++i)
  {
    points->SetPoint(i, output->GetPoint(i));
  }
  flat->SetPoints(points);
  vtkPointData* arrays = flat->GetPointData();
  arrays->Initialize();
  arrays->CopyAllocate(output->GetPointData(), count);
  for (vtkIdType i = 0; i < count; ++i)
  {
    arrays->CopyData(output->GetPointData(), i, i);
  }
  if (vtkDataArray* ids = this->Flat->GetPointData()->GetGlobalIds())
  {
    arrays->SetGlobalIds(ids);
  }
  flat->GetCellData()->ShallowCopy(output->GetCellData());
  flat->GetFieldData()->ShallowCopy(output->GetFieldData());
  output->ShallowCopy(flat);
}
}
