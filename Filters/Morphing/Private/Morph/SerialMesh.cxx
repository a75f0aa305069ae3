// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Morph/SerialMesh.h"

#include "Private/Data/GridMesh.h"
#include "Support/Error.h"
#include "Support/Monitor.h"

#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <utility>

namespace morph::filters
{
bool SerialMesh::Take(
  vtkUnstructuredGrid* grid, const std::string&, const CreateMorpher&, morph::Monitor& monitor)
{
  const morph::Mesh& kept = this->Copy->mesh();
  if (this->Taken.Is(grid) && kept.numberOfCells() > 0)
  {
    return false;
  }
  const bool sameCells = GridMesh::SameCells(grid, kept);
  if (sameCells && GridMesh::SamePoints(grid, kept) && kept.numberOfCells() > 0)
  {
    this->Taken.See(grid);
    return false;
  }
  morph::Mesh mesh = GridMesh::FromGrid(grid, GridMesh::UnknownCells::Refuse, monitor);
  monitor.progress(0.015);
  monitor.check();
  auto rest = std::make_shared<const morph::UndeformedMesh>(
    std::move(mesh), sameCells ? this->Copy.get() : nullptr, monitor);
  monitor.progress(0.03);
  if (!sameCells)
  {
    MovedSurface polygons;
    polygons.Make(grid, rest->mesh(), rest->outerFaces());
    this->Polygons = std::move(polygons);
  }
  this->Copy = std::move(rest);
  this->Taken.See(grid);
  this->SetFeatureLines(false, monitor); // those of other points
  return true;
}

void SerialMesh::SetFeatureLines(bool on, morph::Monitor&)
{
  this->Polygons.SetFeatureLines(on, this->Copy->mesh(), this->Copy->outerFaces());
}

void SerialMesh::WriteUndeformedSurface(vtkUnstructuredGrid* grid, vtkPolyData* surface) const
{
  surface->Initialize();
  if (grid->GetNumberOfCells() == 0)
  {
    return;
  }
  if (GridMesh::SameCells(grid, this->Copy->mesh()))
  {
    this->Polygons.Write(grid->GetPoints(), surface);
    return;
  }
  try
  {
    morph::Monitor monitor;
    SerialMesh other;
    other.Take(grid, "", {}, monitor);
    other.Polygons.Write(grid->GetPoints(), surface);
  }
  catch (const morph::Error&)
  {
    surface->Initialize(); // the error that led here is of this mesh, and is told already
  }
}
}
