// SPDX-License-Identifier: BSD-3-Clause
#include "RandomGrid.h"

#include "Mesh/CellShape.h"
#include "Mesh/CollapsedCells.h"
#include "Mesh/FaceTable.h"
#include "PolyhedralMeshes.h"
#include "RandomMesh.h"
#include "Recount.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkExtractCells.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkImageData.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPartitionedDataSetCollection.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSignedCharArray.h>
#include <vtkStringArray.h>
#include <vtkTable.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

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

/// Adds a polyhedron of `mesh`, whose faces may be flawed.
void addPolyhedron(
  Choices& choices, const morph::Mesh& mesh, Index cell, bool isHostile, vtkUnstructuredGrid* grid)
{
  std::vector<std::vector<vtkIdType>> faces;
  for (Index at = mesh.faceOffsets[cell]; at < mesh.faceOffsets[cell + 1];)
  {
    const Index* first = mesh.faces.data() + at + 1;
    faces.emplace_back(first, first + mesh.faces[at]);
    at += 1 + mesh.faces[at];
  }
  Random random = choices.stream("polyhedron " + std::to_string(cell));
  const int flaw =
    isHostile && random.happens(0.3)
      ? choices.pick("polyhedron",
          { "none", "open", "face twice", "two nodes", "repeated node", "turned face" },
          { 4, 1, 1, 1, 1, 1 })
      : 0;
  std::vector<vtkIdType>& face = faces[random.below(static_cast<int>(faces.size()))];
  switch (flaw)
  {
    case 1:
      faces.pop_back();
      break;
    case 2:
      faces.push_back(faces.front());
      break;
    case 3:
      face.resize(2);
      break;
    case 4:
      face[1] = face[0];
      break;
    case 5:
      std::reverse(face.begin(), face.end());
      break;
    default:
      break;
  }
  vtkNew<vtkIdList> stream;
  stream->InsertNextId(static_cast<vtkIdType>(faces.size()));
  for (const std::vector<vtkIdType>& nodes : faces)
  {
    stream->InsertNextId(static_cast<vtkIdType>(nodes.size()));
    std::for_each(nodes.begin(), nodes.end(), [&](vtkIdType id) { stream->InsertNextId(id); });
  }
  grid->InsertNextCell(VTK_POLYHEDRON, stream);
}

/// Whether some cells have no volume, or are inverted alone.
bool hasNoVolumes(const morph::Mesh& mesh)
{
  morph::Points mirrored = mesh.points;
  mirrored.col(0) *= -1;
  return !isValid(mesh, mesh.points, 0) && !isValid(mesh, mirrored, 0);
}

/// What displacements and zones ask for by name: the vectors "Displacement", and 1 in a part of the
/// mesh, "Marked" of points and "Zone" of cells.
void addMarks(Choices& choices, vtkUnstructuredGrid* grid)
{
  Random random = choices.stream("marks");
  const double length = grid->GetLength(), from = grid->GetCenter()[0];
  vtkNew<vtkDoubleArray> vectors, points, cells;
  vectors->SetName("Displacement");
  vectors->SetNumberOfComponents(3);
  const double amount = random.between(0, 0.1) * length;
  for (vtkIdType p = 0; p < grid->GetNumberOfPoints(); ++p)
  {
    const double* x = grid->GetPoint(p);
    vectors->InsertNextTuple3(amount * std::sin(3 * (x[1] - x[2]) / length), 0, amount);
    points->InsertNextValue(x[0] > from);
  }
  const int part = random.below(static_cast<int>(grid->GetNumberOfCells()) + 1);
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c)
  {
    cells->InsertNextValue(c >= part);
  }
  if (random.happens(0.3)) // as vtkProbeFilter leaves it
  {
    vtkNew<vtkSignedCharArray> mask;
    mask->SetName("vtkValidPointMask");
    for (vtkIdType p = 0; p < grid->GetNumberOfPoints(); ++p)
    {
      mask->InsertNextValue(random.happens(0.8));
    }
    grid->GetPointData()->AddArray(mask);
  }
  points->SetName("Marked");
  cells->SetName("Zone");
  grid->GetPointData()->AddArray(vectors);
  grid->GetPointData()->AddArray(points);
  grid->GetCellData()->AddArray(cells);
}

/// Adds two-dimensional cells on faces inside of the mesh: one of a sheet, two of a baffle.
void addWalls(Choices& choices, morph::Mesh& mesh)
{
  Random random = choices.stream("walls");
  morph::Monitor monitor;
  const morph::FaceTable table = morph::faceTable(mesh, monitor);
  const double share = 0.3 * random.unit();
  for (Index f = 0; f < table.start.back(); ++f)
  {
    const Index size = table.size(f);
    if (table.first[f] == f && table.uses[f] == 2 && (size == 3 || size == 4) &&
        random.happens(share))
    {
      const std::vector<Index> corners(table.corners.begin(f), table.corners.end(f));
      const int sides = random.happens(0.5) ? 1 : 2;
      for (int side = 0; side < sides; ++side)
      {
        meshes::add(mesh, size == 3 ? morph::Triangle : morph::Quad, corners);
      }
    }
  }
}

/// Adds a set to those that the grid names.
void addName(const char* name, vtkDataSetAttributes* data, const std::vector<std::uint8_t>& isIn,
  vtkUnstructuredGrid* grid)
{
  vtkNew<vtkUnsignedCharArray> marks;
  marks->SetName(name);
  for (const std::uint8_t mark : isIn)
  {
    marks->InsertNextValue(mark);
  }
  data->AddArray(marks);
  auto* names =
    vtkStringArray::SafeDownCast(grid->GetFieldData()->GetAbstractArray("SurfaceNames"));
  if (!names)
  {
    vtkNew<vtkStringArray> none;
    none->SetName("SurfaceNames");
    grid->GetFieldData()->AddArray(none);
    names = none;
  }
  names->InsertNextValue(name);
}

/// Names the cells from this one on "Walls".
void nameWalls(vtkIdType first, vtkUnstructuredGrid* grid)
{
  std::vector<std::uint8_t> isWall(grid->GetNumberOfCells(), 0);
  std::fill(isWall.begin() + first, isWall.end(), 1);
  addName("Walls", grid->GetCellData(), isWall, grid);
}

/// Names the sides that are images of each other, or the plane of symmetry, as OpenFOAM's files do.
void nameSides(const Known& known, vtkUnstructuredGrid* grid)
{
  const auto name = [&](const char* set, const std::vector<Index>& nodes)
  {
    std::vector<std::uint8_t> isIn(grid->GetNumberOfPoints(), 0);
    for (const Index node : nodes)
    {
      isIn[node] = 1;
    }
    addName(set, grid->GetPointData(), isIn, grid);
  };
  const auto tell = [&](const char* array, const char* text)
  {
    vtkNew<vtkStringArray> texts;
    texts->SetName(array);
    texts->InsertNextValue(text);
    grid->GetFieldData()->AddArray(texts);
  };
  std::vector<Index> one, other;
  for (const auto& [node, image] : known.images)
  {
    one.push_back(node);
    other.push_back(image);
  }
  if (!one.empty())
  {
    name("One", one);
    name("Other", other);
    tell("PeriodicSurfaces", "One = Other");
  }
  if (!known.plane.empty())
  {
    name("Plane", known.plane);
    tell("SymmetrySurfaces", "Plane");
  }
}

/// Names cells on two sides of a plane, or any, and the nodes that both have. Some cells have no
/// name.
void nameParts(Choices& choices, const morph::Mesh& mesh, vtkUnstructuredGrid* grid)
{
  Random random = choices.stream("parts");
  const bool isPlane = random.happens(0.7);
  const double some = random.happens(0.7) ? 1 : random.between(0.5, 1);
  const double plane = mesh.points.rows() > 0 ? mesh.points.col(0).mean() : 0;
  std::vector<std::uint8_t> isIn[2], hasNode[2];
  for (int part = 0; part < 2; ++part)
  {
    isIn[part].assign(mesh.numberOfCells(), 0);
    hasNode[part].assign(mesh.numberOfNodes(), 0);
  }
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const bool isRight = isPlane && mesh.cellSize(c) > 0 ? mesh.points(mesh.cell(c)[0], 0) > plane
                                                         : random.happens(0.5);
    if (random.happens(some))
    {
      isIn[isRight][c] = 1;
      for (Index k = 0; k < mesh.cellSize(c); ++k)
      {
        hasNode[isRight][mesh.cell(c)[k]] = 1;
      }
    }
  }
  for (std::size_t n = 0; n < hasNode[0].size(); ++n)
  {
    hasNode[0][n] = hasNode[0][n] && hasNode[1][n];
  }
  addName("Left", grid->GetCellData(), isIn[0], grid);
  addName("Right", grid->GetCellData(), isIn[1], grid);
  addName("Between", grid->GetPointData(), hasNode[0], grid);
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
    grid->SetCells(types, cells, grid->GetFaceLocations(), grid->GetFaces());
  }
}

vtkSmartPointer<vtkUnstructuredGrid> makeGrid(
  Choices& choices, const morph::Mesh& mesh, bool isHostile)
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
  // Cells as hexahedra that name nodes twice.
  static const std::map<std::uint8_t, std::vector<int>> Disguises = {
    { morph::Tetra, { 0, 1, 2, 2, 3, 3, 3, 3 } }, { morph::Pyramid, { 0, 1, 2, 3, 4, 4, 4, 4 } },
    { morph::Wedge, { 0, 1, 2, 2, 3, 4, 5, 5 } }
  };
  const bool areDisguised = choices.chance("with.disguised", 0.06);
  Random random = choices.stream("with.disguised");
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    if (mesh.types[c] == morph::Polyhedron)
    {
      addPolyhedron(choices, mesh, c, isHostile, grid);
      continue;
    }
    std::vector<vtkIdType> nodes(mesh.cell(c), mesh.cell(c) + mesh.cellSize(c));
    std::uint8_t type = mesh.types[c];
    const auto disguise = Disguises.find(type);
    if (areDisguised && disguise != Disguises.end() && random.happens(0.5))
    {
      std::vector<vtkIdType> corners;
      std::transform(disguise->second.begin(), disguise->second.end(), std::back_inserter(corners),
        [&](int k) { return nodes[k]; });
      nodes = corners;
      type = morph::Hexahedron;
    }
    grid->InsertNextCell(type, static_cast<vtkIdType>(nodes.size()), nodes.data());
  }
  if (choices.chance("grid.32bit", 0.25))
  {
    grid->GetCells()->ConvertTo32BitStorage();
  }
  return grid;
}

/// The cells in two blocks, which have all points each, or their own.
vtkSmartPointer<vtkDataObject> inBlocks(Choices& choices, vtkUnstructuredGrid* grid)
{
  vtkNew<vtkExtractCells> cells[2];
  Random random = choices.stream("blocks");
  const vtkIdType cut = random.below(static_cast<int>(grid->GetNumberOfCells()) + 1);
  vtkSmartPointer<vtkUnstructuredGrid> blocks[2];
  for (int b = 0; b < 2; ++b)
  {
    cells[b]->SetInputData(grid);
    const vtkIdType first = b == 0 ? 0 : cut, end = b == 0 ? cut : grid->GetNumberOfCells();
    if (first < end)
    {
      cells[b]->AddCellRange(first, end - 1);
    }
    cells[b]->Update();
    blocks[b] = cells[b]->GetOutput();
  }
  if (random.happens(0.5))
  {
    auto result = vtkSmartPointer<vtkPartitionedDataSetCollection>::New();
    result->SetPartition(0, 0, blocks[0]);
    result->SetPartition(1, 0, blocks[1]);
    return result;
  }
  auto result = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  result->SetBlock(0, blocks[0]);
  result->SetBlock(2, blocks[1]); // after an empty one
  return result;
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
  result.mesh = randomMesh(choices, result.known);
  result.hasWalls = !result.isShell() && choices.chance("with.walls", 0.06);
  const Index firstWall = result.mesh.numberOfCells();
  if (result.hasWalls)
  {
    addWalls(choices, result.mesh);
  }
  const bool hostile = choices.chance("hostile.grid", 0.1);
  const double polyhedra = choices.number("with.polyhedra", 0,
    [](Random& random) { return random.happens(0.05) ? random.between(0.3, 1.5) : 0; });
  Random random = choices.stream("cells.polyhedra");
  const auto isChosen = [&](Index c)
  {
    const morph::CellShape* shape = morph::cellShape(result.mesh.types[c]);
    const bool isLinear = shape && shape->dimension == 3 && shape->numberOfNodes > 0 &&
                          shape->numberOfNodes == shape->numberOfCorners;
    return isLinear && random.happens(polyhedra);
  };
  const morph::Mesh mesh = polyhedra > 0 ? meshes::asPolyhedra(result.mesh, isChosen) : result.mesh;
  auto grid = makeGrid(choices, mesh, hostile);
  result.isAsMesh = polyhedra == 0;
  result.mesh.points = pointsOf(grid);
  morph::Monitor serial;
  morph::recognizeCells(result.mesh, serial);
  result.nodes = cellNodes(result.mesh, result.known);
  result.size = meshSize(result.mesh, result.nodes);
  if (result.known.faces == Known::Plane &&
      !(planeOf(result.mesh.points(result.nodes, morph::allColumns)).first < 1e-8 * result.size))
  {
    result.isAsMesh = false; // coordinates of few digits leave the plane, or nearly so
  }
  // Coordinates of few digits put nodes off their faces, or nearly so, or leave faces no area.
  if (!(result.known.gap(result.mesh.points) < 1e-9 * result.size) ||
      (!result.known.hanging.empty() && hasNoVolumes(result.mesh)))
  {
    result.isAsMesh = false;
  }
  result.outer = result.known.outer.empty() ? outerNodes(result.mesh) : result.known.outer;
  result.data = grid;

  if (hostile && grid->GetNumberOfPoints() > 0 && choices.chance("cells.foreign", 0.12))
  {
    addForeignCells(choices, grid);
    result.isAsMesh = false;
  }
  if (result.hasWalls)
  {
    nameWalls(firstWall, grid);
  }
  result.hasParts = result.isAsMesh && !result.isShell() && choices.chance("with.parts", 0.08);
  if (result.hasParts)
  {
    nameParts(choices, result.mesh, grid);
  }
  nameSides(result.known, grid);
  if (choices.chance("with.marks", 0.2))
  {
    addMarks(choices, grid);
  }
  addArrays(choices, grid, "grid", hostile, result.hasOddArrays);
  result.hasGhosts = grid->GetCellGhostArray() || grid->GetPointGhostArray();
  if (hostile && grid->GetNumberOfCells() > 0 && choices.chance("cells.areSpoilt", 0.12))
  {
    spoilCells(choices, grid);
    result.isAsMesh = false;
  }
  if (!hostile && choices.chance("with.blocks", 0.05))
  {
    result.data = inBlocks(choices, grid);
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
