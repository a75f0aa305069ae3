// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Morph/KeptMesh.h"

#include "Mesh/SharedCorners.h"
#include "Private/Data/GridMesh.h"
#include "Private/Data/Quality.h"
#include "Private/Pipeline/Input.h"
#include "Support/Error.h"
#include "Support/Monitor.h"

#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <utility>

namespace morph::filters
{
bool KeptMesh::Take(vtkUnstructuredGrid* grid, morph::Monitor& monitor)
{
  if (this->Taken.Is(grid) && this->Copy->numberOfCells() > 0)
  {
    return false;
  }
  const bool sameCells = GridMesh::SameCells(grid, *this->Copy);
  if (sameCells && GridMesh::SamePoints(grid, *this->Copy) && this->Copy->numberOfCells() > 0)
  {
    this->Taken.See(grid);
    return false;
  }
  morph::Mesh mesh = GridMesh::FromGrid(grid, GridMesh::UnknownCells::Refuse, monitor);
  Input::RequireVolumeCells(mesh);
  const morph::ConnectedComponents bodies = morph::connectedComponents(mesh, monitor);
  std::vector<std::int8_t> signs = morph::cellSigns(mesh, bodies, monitor);
  const morph::Index mirrored = Quality::MirroredBodies(bodies, signs);
  if (!sameCells)
  {
    morph::BoundaryFaces outer = morph::boundaryFaces(mesh, monitor);
    MovedSurface polygons;
    polygons.Make(grid, mesh, outer);
    this->Repeated = morph::repeatedCells(mesh, monitor);
    this->Touching = morph::touchingNodes(mesh, outer);
    this->Outer = std::move(outer);
    this->Polygons = std::move(polygons);
  }
  this->Mirrored = mirrored;
  this->Signs = std::move(signs);
  this->Diameter = GridMesh::Size(mesh);
  this->Copy = std::make_shared<morph::Mesh>(std::move(mesh));
  this->Inverted.reset();
  this->Taken.See(grid);
  this->SetFeatureLines(false); // those of other points
  return true;
}

const morph::InvertedBefore& KeptMesh::Before(morph::Monitor& monitor) const
{
  if (!this->Inverted)
  {
    this->Inverted.emplace(*this->Copy, this->Signs,
      morph::measureQuality(*this->Copy, this->Copy->points, this->Signs, {}, monitor));
  }
  return *this->Inverted;
}

void KeptMesh::WriteUndeformedSurface(vtkUnstructuredGrid* grid, vtkPolyData* surface) const
{
  surface->Initialize();
  if (grid->GetNumberOfCells() == 0)
  {
    return;
  }
  if (GridMesh::SameCells(grid, *this->Copy))
  {
    this->Polygons.Write(grid->GetPoints(), surface);
    return;
  }
  try
  {
    morph::Monitor monitor;
    KeptMesh other;
    other.Take(grid, monitor);
    other.Polygons.Write(grid->GetPoints(), surface);
  }
  catch (const morph::Error&)
  {
    surface->Initialize(); // the error that led here is of this mesh, and is told already
  }
}
}
