// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Data/MovedSurface.h"

#include "Boundary/Classification.h"
#include "Boundary/SurfaceEdges.h"
#include "Boundary/SurfacePatches.h"
#include "Private/Data/Arrays.h"
#include "Private/Data/Surface.h"
#include "Support/Lists.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <limits>

namespace morph::filters
{
namespace
{
/// Copies the points `ids` where both arrays are of this class; returns whether they are.
template <typename Array>
bool gather(vtkDataArray* from, vtkIdTypeArray* ids, vtkDataArray* to)
{
  auto *source = Array::FastDownCast(from), *target = Array::FastDownCast(to);
  if (!source || !target)
  {
    return false;
  }
  const auto* values = source->GetPointer(0);
  auto* next = target->GetPointer(0);
  for (vtkIdType i = 0; i < ids->GetNumberOfValues(); ++i)
  {
    next = std::copy_n(values + 3 * ids->GetValue(i), 3, next);
  }
  return true;
}
}

void MovedSurface::Make(vtkUnstructuredGrid* grid, const morph::Mesh& mesh,
  const morph::BoundaryFaces& faces, const std::vector<std::int8_t>* orientation)
{
  vtkNew<vtkPolyData> surface;
  this->Faces = Surface::Write(grid, mesh, faces, surface, orientation);
  this->Polygons = surface->GetPolys();
  this->Nodes = vtkIdTypeArray::SafeDownCast(surface->GetPointData()->GetArray(Surface::IdName));
  this->Owners = vtkIdTypeArray::SafeDownCast(surface->GetCellData()->GetArray("MorphCellId"));
  this->Outer = faces.cells;
  sortUnique(this->Outer);
}

void MovedSurface::SetFeatureLines(bool on, const morph::Mesh& mesh,
  const morph::BoundaryFaces& faces,
  const std::function<bool(const std::vector<morph::Index>& cells)>& isDrawn)
{
  if (on == (this->Lines != nullptr))
  {
    return;
  }
  vtkSmartPointer<vtkCellArray> lines;
  if (on)
  {
    lines = vtkSmartPointer<vtkCellArray>::New();
    morph::Monitor serial;
    const morph::SurfaceEdges edges = morph::surfaceEdges(mesh.points, faces, serial);
    const std::vector<std::uint8_t> isFeature = morph::surfacePatches(
      faces, edges, morph::ClassificationOptions().featureAngle, {}, {}, false)
                                                  .isCurve;
    std::vector<vtkIdType> number(mesh.numberOfNodes(), -1);
    for (vtkIdType i = 0; i < this->Nodes->GetNumberOfValues(); ++i)
    {
      number[this->Nodes->GetValue(i)] = i;
    }
    for (morph::Index edge = 0; edge < edges.count(); ++edge)
    {
      std::vector<morph::Index> cells;
      for (const morph::Index* face = edges.faces.begin(edge); face != edges.faces.end(edge);
           ++face)
      {
        cells.push_back(faces.cells[*face]);
      }
      if (isFeature[edge] && (!isDrawn || isDrawn(cells)))
      {
        lines->InsertNextCell({ number[edges.nodes[edge][0]], number[edges.nodes[edge][1]] });
      }
    }
  }
  const vtkIdType before = this->Lines ? this->Lines->GetNumberOfCells() : 0;
  const vtkIdType count = lines ? lines->GetNumberOfCells() : 0;
  auto owners = Arrays::Make<vtkIdTypeArray>(
    this->Owners->GetName(), this->Owners->GetNumberOfValues() - before + count);
  std::fill_n(owners->GetPointer(0), count, -1);
  std::copy(this->Owners->GetPointer(before),
    this->Owners->GetPointer(0) + this->Owners->GetNumberOfValues(), owners->GetPointer(count));
  this->Owners = owners;
  this->Lines = lines;
}

void MovedSurface::Write(vtkPoints* moved, vtkPolyData* output) const
{
  output->Initialize();
  const vtkIdType count = this->Nodes->GetNumberOfValues();
  auto points = Arrays::MakePoints(moved->GetDataType(), count);
  if (!gather<vtkDoubleArray>(moved->GetData(), this->Nodes, points->GetData()) &&
      !gather<vtkFloatArray>(moved->GetData(), this->Nodes, points->GetData()))
  {
    for (vtkIdType i = 0; i < count; ++i)
    {
      points->SetPoint(i, moved->GetPoint(this->Nodes->GetValue(i)));
    }
  }
  output->SetPoints(points);
  output->SetLines(this->Lines);
  output->SetPolys(this->Polygons);
  output->GetPointData()->AddArray(this->Nodes);
  output->GetCellData()->AddArray(this->Owners);
}

vtkIdType MovedSurface::Write(
  vtkPoints* moved, const morph::Quality& quality, vtkPolyData* output) const
{
  this->Write(moved, output);
  auto scaledJacobian =
    Arrays::Make<vtkDoubleArray>("ScaledJacobian", this->Owners->GetNumberOfValues());
  for (vtkIdType i = 0; i < this->Owners->GetNumberOfValues(); ++i)
  {
    const vtkIdType owner = this->Owners->GetValue(i);
    scaledJacobian->SetValue(
      i, owner < 0 ? std::numeric_limits<double>::quiet_NaN() : quality.scaledJacobian[owner]);
  }
  output->GetCellData()->SetScalars(scaledJacobian);
  return std::count_if(this->Outer.begin(), this->Outer.end(),
    [&quality](morph::Index cell) { return quality.scaledJacobian[cell] <= 0; });
}

void MovedSurface::MarkCrossing(const std::vector<morph::Index>& faces, vtkPolyData* output) const
{
  vtkNew<vtkUnsignedCharArray> crosses;
  crosses->SetName("CrossesItself");
  crosses->SetNumberOfValues(this->Owners->GetNumberOfValues());
  crosses->FillValue(0);
  const vtkIdType first = crosses->GetNumberOfValues() - static_cast<vtkIdType>(this->Faces.size());
  for (std::size_t i = 0; i < this->Faces.size(); ++i)
  {
    const bool isOne = std::binary_search(faces.begin(), faces.end(), this->Faces[i]);
    crosses->SetValue(first + static_cast<vtkIdType>(i), isOne);
  }
  output->GetCellData()->AddArray(crosses);
}
}
