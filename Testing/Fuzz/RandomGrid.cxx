// SPDX-License-Identifier: BSD-3-Clause
#include "RandomGrid.h"

#include "RandomMesh.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkImageData.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkTable.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>

namespace fuzz
{
namespace
{
using morph::Index;

/// Cells of types that the library does not know.
void addForeignCells(Choices& choices, vtkUnstructuredGrid* grid)
{
  constexpr int types[] = { VTK_CONVEX_POINT_SET, VTK_PENTAGONAL_PRISM, VTK_HEXAGONAL_PRISM,
    VTK_LAGRANGE_TETRAHEDRON, VTK_LAGRANGE_HEXAHEDRON, VTK_BEZIER_WEDGE, VTK_CUBIC_LINE,
    VTK_QUADRATIC_POLYGON, 200 };
  constexpr int sizes[] = { 5, 10, 12, 4, 8, 6, 4, 8, 3 };
  Random random = choices.stream("cells.foreign");
  const int which = random.below(static_cast<int>(std::size(types)));
  const auto any = [&]
  { return static_cast<vtkIdType>(random.below(static_cast<int>(grid->GetNumberOfPoints()))); };
  std::vector<vtkIdType> nodes(sizes[which]);
  std::generate(nodes.begin(), nodes.end(), any);
  grid->InsertNextCell(types[which], static_cast<vtkIdType>(nodes.size()), nodes.data());
}

/// A tetrahedron as a polyhedron, of any points, that may lack a face or have a wrong one.
void addPolyhedron(Choices& choices, vtkUnstructuredGrid* grid)
{
  const int flaw = choices.pick("polyhedron",
    { "none", "open", "face twice", "two nodes", "repeated node", "turned face" },
    { 4, 1, 1, 1, 1, 1 });
  Random random = choices.stream("cells.polyhedron");
  vtkIdType p[4];
  for (vtkIdType& point : p)
  {
    point = random.below(static_cast<int>(grid->GetNumberOfPoints()));
  }
  std::vector<std::vector<vtkIdType>> faces = { { p[0], p[1], p[2] }, { p[0], p[3], p[1] },
    { p[1], p[3], p[2] }, { p[2], p[3], p[0] } };
  switch (flaw)
  {
    case 1:
      faces.pop_back();
      break;
    case 2:
      faces.push_back(faces.front());
      break;
    case 3:
      faces[2].pop_back();
      break;
    case 4:
      faces[1][2] = faces[1][0];
      break;
    case 5:
      std::reverse(faces[3].begin(), faces[3].end());
      break;
    default:
      break;
  }
  vtkNew<vtkIdList> stream;
  stream->InsertNextId(static_cast<vtkIdType>(faces.size()));
  for (const std::vector<vtkIdType>& face : faces)
  {
    stream->InsertNextId(static_cast<vtkIdType>(face.size()));
    std::for_each(face.begin(), face.end(), [&](vtkIdType id) { stream->InsertNextId(id); });
  }
  grid->InsertNextCell(VTK_POLYHEDRON, stream);
}

/// Node ids that do not exist, cells with too few nodes, lists that are too short.
void spoilCells(Choices& choices, vtkUnstructuredGrid* grid)
{
  Random random = choices.stream("cells.spoilt");
  const int how = choices.pick("cells.spoilt",
    { "none", "id that does not exist", "negative id", "too few nodes", "types too short" },
    { 0, 3, 2, 2, 2 });
  vtkCellArray* cells = grid->GetCells();
  vtkDataArray* ids = cells->GetConnectivityArray();
  if (how == 1 || how == 2)
  {
    const int value = how == 1 ? static_cast<int>(grid->GetNumberOfPoints()) + random.below(3)
                               : -1 - random.below(3);
    ids->SetComponent(random.below(static_cast<int>(ids->GetNumberOfTuples())), 0, value);
  }
  else if (how == 3)
  {
    const vtkIdType nodes[] = { 0, 0 };
    grid->InsertNextCell(VTK_TETRA, 2, nodes);
  }
  else if (how == 4)
  {
    vtkNew<vtkUnsignedCharArray> types;
    const auto count = random.below(static_cast<int>(grid->GetNumberOfCells()));
    for (int c = 0; c < count; ++c)
    {
      types->InsertNextValue(static_cast<unsigned char>(grid->GetCellType(c)));
    }
    grid->SetCells(types, cells);
  }
}

vtkSmartPointer<vtkUnstructuredGrid> makeGrid(Choices& choices, const morph::Mesh& mesh)
{
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  constexpr int types[] = { VTK_DOUBLE, VTK_FLOAT, VTK_INT };
  points->SetDataType(
    types[choices.pick("grid.points", { "double", "float", "int" }, { 7, 3, 0.1 })]);
  points->SetNumberOfPoints(mesh.numberOfNodes());
  for (Index n = 0; n < mesh.numberOfNodes(); ++n)
  {
    Eigen::RowVector3d x = mesh.points.row(n);
    if (points->GetDataType() == VTK_INT)
    {
      x = x.array().isFinite().select(x.array().max(-1e9).min(1e9), 0).matrix();
    }
    points->SetPoint(n, x.data());
  }
  grid->SetPoints(points);
  grid->Allocate(mesh.numberOfCells());
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const std::vector<vtkIdType> nodes(mesh.cell(c), mesh.cell(c) + mesh.cellSize(c));
    grid->InsertNextCell(mesh.types[c], static_cast<vtkIdType>(nodes.size()), nodes.data());
  }
  if (choices.chance("grid.32bit", 0.25))
  {
    grid->GetCells()->ConvertTo32BitStorage();
  }
  return grid;
}

vtkSmartPointer<vtkDataObject> otherData(int type, vtkUnstructuredGrid* grid)
{
  switch (type)
  {
    case 1:
      return nullptr;
    case 2:
    {
      auto blocks = vtkSmartPointer<vtkMultiBlockDataSet>::New();
      blocks->SetBlock(0, grid);
      return blocks;
    }
    case 3:
    {
      auto surface = vtkSmartPointer<vtkPolyData>::New();
      surface->SetPoints(grid->GetPoints());
      return surface;
    }
    case 4:
    {
      auto image = vtkSmartPointer<vtkImageData>::New();
      image->SetDimensions(3, 3, 3);
      return image;
    }
    case 5:
      return vtkSmartPointer<vtkTable>::New();
    default:
      return vtkSmartPointer<vtkUnstructuredGrid>::New();
  }
}
}

morph::Points pointsOf(vtkPointSet* data)
{
  morph::Points result(data->GetNumberOfPoints(), 3);
  for (Index n = 0; n < result.rows(); ++n)
  {
    data->GetPoint(n, result.row(n).data());
  }
  return result;
}

RandomGrid randomGrid(Choices& choices)
{
  RandomGrid result;
  result.mesh = randomMesh(choices);
  auto grid = makeGrid(choices, result.mesh);
  result.mesh.points = pointsOf(grid);
  result.outer = outerNodes(result.mesh);
  result.size = meshSize(result.mesh);
  result.data = grid;

  const bool hostile = choices.chance("hostile.grid", 0.1);
  if (hostile && grid->GetNumberOfPoints() > 0 && choices.chance("cells.foreign", 0.12))
  {
    addForeignCells(choices, grid);
    result.isAsMesh = false;
  }
  if (hostile && grid->GetNumberOfPoints() > 0 && choices.chance("cells.polyhedral", 0.25))
  {
    addPolyhedron(choices, grid);
    result.isAsMesh = false;
  }
  addArrays(choices, grid, "grid", hostile, result.hasOddArrays);
  result.hasGhosts = grid->GetCellGhostArray() || grid->GetPointGhostArray();
  if (hostile && grid->GetNumberOfCells() > 0 && choices.chance("cells.areSpoilt", 0.12))
  {
    spoilCells(choices, grid);
    result.isAsMesh = false;
  }
  if (hostile)
  {
    const int type = choices.pick("grid.type",
      { "grid", "nothing", "blocks", "polygonal data", "image", "table", "empty grid" },
      { 20, 0.3, 0.3, 0.3, 0.3, 0.3, 0.5 });
    if (type > 0)
    {
      result.data = otherData(type, grid);
      result.isAsMesh = false;
    }
  }
  return result;
}
}
