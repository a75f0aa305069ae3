// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Data/Surface.h"

#include "Mesh/Polyhedra.h"
#include "Private/Data/Arrays.h"
#include "Private/Data/Faces.h"

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
#include <map>

namespace morph::filters
{
namespace
{
/// The pieces of each face of each shape of cells, computed at first use.
class FacePieces
{
public:
  /// The pieces of boundary face `face`.
  const std::vector<Faces::Polygon>& Of(
    const morph::Mesh& mesh, const morph::BoundaryFaces& faces, morph::Index face)
  {
    const morph::Index cell = faces.cells[face];
    const morph::CellShape& shape = *morph::cellShape(mesh, cell);
    auto& pieces = this->ByShape[&shape];
    if (pieces.empty())
    {
      for (int f = 0; f < shape.numberOfFaces; ++f)
      {
        pieces.push_back(Faces::Pieces(shape, f));
      }
    }
    return pieces[faces.sides[face]];
  }

private:
  std::map<const morph::CellShape*, std::vector<std::vector<Faces::Polygon>>> ByShape;
};

void writePoints(
  vtkUnstructuredGrid* grid, const std::vector<morph::Index>& nodes, vtkPolyData* output)
{
  const vtkIdType count = static_cast<vtkIdType>(nodes.size());
  vtkNew<vtkPoints> points;
  if (grid->GetPoints()) // an MPI rank without cells may have none
  {
    points->SetDataType(grid->GetPoints()->GetDataType());
  }
  points->SetNumberOfPoints(count);
  auto ids = Arrays::Make<vtkIdTypeArray>(Surface::IdName, count);
  auto rest = Arrays::Make<vtkDoubleArray>(Surface::RestName, count, 4);
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
  Arrays::Add(ids, to);
  Arrays::Add(rest, to);
  output->SetPoints(points);
}

std::vector<morph::Index> writePolygons(vtkUnstructuredGrid* grid, const morph::Mesh& mesh,
  const morph::BoundaryFaces& faces, const std::vector<std::int8_t>& orientation,
  vtkPolyData* output)
{
  std::vector<vtkIdType> number(mesh.numberOfNodes(), -1);
  for (std::size_t i = 0; i < faces.nodes.size(); ++i)
  {
    number[faces.nodes[i]] = static_cast<vtkIdType>(i);
  }

  vtkNew<vtkCellArray> polygons;
  auto owners = Arrays::Make<vtkIdTypeArray>("MorphCellId");
  vtkCellData* from = grid->GetCellData();
  vtkCellData* to = output->GetCellData();
  to->CopyGlobalIdsOff();
  to->CopyAllocate(from, static_cast<vtkIdType>(faces.cells.size()));

  std::vector<morph::Index> faceOf;
  FacePieces pieces;
  std::vector<vtkIdType> points;
  const auto writePolygon = [&](std::size_t face)
  {
    const morph::Index owner = faces.cells[face];
    // A collapsed cell repeats nodes.
    points.erase(std::unique(points.begin(), points.end()), points.end());
    if (points.size() > 1 && points.front() == points.back())
    {
      points.pop_back();
    }
    if (points.size() < 3)
    {
      return;
    }
    if (orientation[owner] < 0)
    {
      std::reverse(points.begin(), points.end());
    }
    const vtkIdType cell =
      polygons->InsertNextCell(static_cast<vtkIdType>(points.size()), points.data());
    owners->InsertNextValue(owner);
    faceOf.push_back(static_cast<morph::Index>(face));
    to->CopyData(from, owner, cell);
  };
  for (std::size_t face = 0; face < faces.cells.size(); ++face)
  {
    const morph::Index owner = faces.cells[face];
    if (morph::isPolyhedron(mesh, owner))
    {
      points.clear();
      for (morph::Index k = faces.offsets[face]; k < faces.offsets[face + 1]; ++k)
      {
        points.push_back(number[faces.connectivity[k]]);
      }
      writePolygon(face);
      continue;
    }
    for (const auto& polygon : pieces.Of(mesh, faces, static_cast<morph::Index>(face)))
    {
      points.clear();
      for (int place : polygon)
      {
        points.push_back(number[mesh.cell(owner)[place]]);
      }
      writePolygon(face);
    }
  }
  Arrays::Add(owners, to);
  output->SetPolys(polygons);
  return faceOf;
}
}

namespace Surface
{
std::vector<morph::Index> Write(vtkUnstructuredGrid* grid, const morph::Mesh& mesh,
  const morph::BoundaryFaces& faces, vtkPolyData* output,
  const std::vector<std::int8_t>* orientation)
{
  writePoints(grid, faces.nodes, output);
  return orientation ? writePolygons(grid, mesh, faces, *orientation, output)
                     : writePolygons(grid, mesh, faces,
                         morph::cellSigns(mesh, morph::connectedComponents(mesh)), output);
}

void WarnOfNone(const morph::BoundaryFaces& faces, morph::Monitor& monitor)
{
  if (faces.nodes.empty())
  {
    monitor.warn(
      "The boundary is empty: every face of the input's cells belongs to two cells or "
      "more, as the edges of a closed shell do. Give points or lines at its nodes as the "
      "boundary, or move everything.");
  }
}
}
}
