// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Data/MovedSurface.h"

#include "Private/Data/Surface.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>

namespace morph::filters
{
void MovedSurface::Make(
  vtkUnstructuredGrid* grid, const morph::Mesh& mesh, const morph::BoundaryFaces& faces)
{
  vtkNew<vtkPolyData> surface;
  Surface::Write(grid, mesh, faces, surface);
  this->Polygons = surface->GetPolys();
  this->Nodes = vtkIdTypeArray::SafeDownCast(surface->GetPointData()->GetArray(Surface::IdName));
  this->Owners = vtkIdTypeArray::SafeDownCast(surface->GetCellData()->GetArray("MorphCellId"));
  this->Inner.assign(mesh.numberOfCells(), 1);
  for (const morph::Index cell : faces.cells)
  {
    this->Inner[cell] = 0;
  }
}

void MovedSurface::Write(vtkPoints* moved, vtkPolyData* output) const
{
  output->Initialize();
  const vtkIdType count = this->Nodes->GetNumberOfValues();
  vtkNew<vtkPoints> points;
  points->SetDataType(moved->GetDataType());
  points->SetNumberOfPoints(count);
  for (vtkIdType i = 0; i < count; ++i)
  {
    points->SetPoint(i, moved->GetPoint(this->Nodes->GetValue(i)));
  }
  output->SetPoints(points);
  output->SetPolys(this->Polygons);
  output->GetPointData()->AddArray(this->Nodes);
  output->GetCellData()->AddArray(this->Owners);
}

vtkIdType MovedSurface::Write(
  vtkPoints* moved, const morph::Quality& quality, vtkPolyData* output) const
{
  this->Write(moved, output);
  vtkNew<vtkDoubleArray> scaledJacobian;
  scaledJacobian->SetName("ScaledJacobian");
  scaledJacobian->SetNumberOfValues(this->Owners->GetNumberOfValues());
  for (vtkIdType i = 0; i < this->Owners->GetNumberOfValues(); ++i)
  {
    scaledJacobian->SetValue(i, quality.scaledJacobian[this->Owners->GetValue(i)]);
  }
  output->GetCellData()->SetScalars(scaledJacobian);
  const std::vector<morph::Index> bad = morph::invertedCells(quality);
  return std::count_if(
    bad.begin(), bad.end(), [this](morph::Index cell) { return this->Inner[cell] == 0; });
}
}
