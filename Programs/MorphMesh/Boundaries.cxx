// SPDX-License-Identifier: BSD-3-Clause
#include "Boundaries.h"

#include "Arguments.h"
#include "Files.h"
#include "Messages.h"
#include "NumberColumns.h"

#include "Files/ReadFile.h"
#include "Formats/FoamList.h"

#include <vtkBoundaryDisplacement.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataArraySelection.h>
#include <vtkDoubleArray.h>
#include <vtkExtractMorphBoundary.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkMath.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkTable.h>
#include <vtkTrivialProducer.h>
#include <vtkUnstructuredGrid.h>
#include <vtksys/RegularExpression.hxx>

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <map>
#include <set>
#include <sstream>
#include <vector>

namespace morph_mesh
{
namespace
{
namespace io = morph::io;

/// The numbers of the nodes in the file that a grid was read from; null where there are none.
vtkDataArray* numbersOf(vtkPointSet* grid)
{
  vtkDataArray* numbers = grid->GetPointData()->GetGlobalIds();
  for (const char* name : { "NodeNumber", "GlobalNodeId" }) // of our reader, of VTK's of Exodus II
  {
    numbers = numbers ? numbers : grid->GetPointData()->GetArray(name);
  }
  return numbers;
}

/// The point of each of the file's node numbers.
std::map<vtkIdType, vtkIdType> pointOfNumber(vtkDataArray* numbers)
{
  std::map<vtkIdType, vtkIdType> points;
  for (vtkIdType i = 0; i < numbers->GetNumberOfTuples(); ++i)
  {
    points.emplace(static_cast<vtkIdType>(numbers->GetComponent(i, 0)), i);
  }
  return points;
}

vtkSmartPointer<vtkPolyData> readTarget(const std::string& path)
{
  vtkSmartPointer<vtkPolyData> surface = vtkPolyData::SafeDownCast(readPoints(path));
  if (!surface)
  {
    throw Failure(path + " is no surface: --target needs one, an .stl file for instance.");
  }
  return surface;
}

/// A table of points, by its extension, or any data of VTK's and of solvers.
vtkSmartPointer<vtkDataObject> readField(const std::string& path, int timeStep)
{
  const std::string kind = extensionOf(path);
  if (kind != ".csv" && kind != ".tsv" && kind != ".txt")
  {
    return readFile(path, timeStep);
  }
  const std::vector<std::string> names = { "x", "y", "z", "dx", "dy", "dz" };
  const std::vector<NumberLine> lines = readNumbers(path, names);
  auto table = vtkSmartPointer<vtkTable>::New();
  for (std::size_t c = 0; c < names.size(); ++c)
  {
    vtkNew<vtkDoubleArray> column;
    column->SetName(names[c].c_str());
    for (const NumberLine& line : lines)
    {
      column->InsertNextValue(line.numbers[c]);
    }
    table->AddColumn(column);
  }
  return table;
}

using Displacements = std::vector<std::pair<vtkIdType, std::array<double, 3>>>; ///< of point ids

Displacements displacementsOfTable(
  vtkUnstructuredGrid* grid, const std::string& path, bool nodeNumbers)
{
  if (nodeNumbers && !numbersOf(grid))
  {
    throw Failure("The grid's file has no node numbers: leave --node-numbers out, and give 0-based "
                  "point ids.");
  }
  const auto points =
    nodeNumbers ? pointOfNumber(numbersOf(grid)) : std::map<vtkIdType, vtkIdType>();
  Displacements result;
  std::map<vtkIdType, const NumberLine*> lines;
  const std::vector<NumberLine> table = readNumbers(path, { "id", "dx", "dy", "dz" });
  for (const NumberLine& line : table)
  {
    const std::vector<double>& values = line.numbers;
    const auto given = static_cast<vtkIdType>(values[0]);
    const auto found = points.find(given);
    const vtkIdType id = !nodeNumbers ? given : found == points.end() ? -1 : found->second;
    if (id < 0 || id >= grid->GetNumberOfPoints() || values[0] != std::floor(values[0]))
    {
      std::ostringstream number;
      number << values[0];
      throw Failure(line.where + "the grid has no node '" + number.str() + "'.");
    }
    const auto [first, isNew] = lines.emplace(id, &line);
    if (!isNew && first->second->numbers != values)
    {
      throw Failure(line.where + "the node " + std::to_string(given) +
                    " has another displacement than in " + first->second->where +
                    "Leave one of them out.");
    }
    result.push_back({ id, { values[1], values[2], values[3] } });
  }
  return result;
}

/// The points of a patch in OpenFOAM's order: as its faces name them first.
std::vector<vtkIdType> pointsOfPatch(vtkUnstructuredGrid* grid, vtkDataArray* faces)
{
  std::vector<vtkIdType> points;
  std::set<vtkIdType> known;
  vtkNew<vtkIdList> corners;
  for (vtkIdType cell = 0; cell < faces->GetNumberOfTuples(); ++cell)
  {
    if (faces->GetComponent(cell, 0) == 0)
    {
      continue;
    }
    grid->GetCellPoints(cell, corners);
    for (const vtkIdType point : *corners)
    {
      if (known.insert(point).second)
      {
        points.push_back(point);
      }
    }
  }
  return points;
}

/// The entry that OpenFOAM takes for a patch: that of its name, or else the last pattern that fits.
const io::FoamList::PatchVectors* entryOf(
  const std::vector<io::FoamList::PatchVectors>& entries, const std::string& patch)
{
  const io::FoamList::PatchVectors* result = nullptr;
  for (const io::FoamList::PatchVectors& entry : entries)
  {
    if (entry.name == patch)
    {
      return &entry;
    }
    if (!entry.isPattern)
    {
      continue;
    }
    vtksys::RegularExpression whole;
    if (!whole.compile("^(" + entry.name + ")$"))
    {
      throw Failure(
        "The boundaryField has the pattern '" + entry.name + "', which is no regular expression.");
    }
    result = whole.find(patch) ? &entry : result;
  }
  return result;
}

/// Of a field such as 0/pointDisplacement. A point of several patches moves as the first of them
/// that moves it.
Displacements displacementsOfField(vtkUnstructuredGrid* grid, const std::string& path)
{
  io::FoamList file(path);
  const auto entries = file.boundaryField();
  // A velocity has a negative exponent.
  if (file.type() != "pointVectorField" || file.dimensions().find('-') != std::string::npos)
  {
    throw Failure(path + " is a field of OpenFOAM of the class " + file.type() +
                  " and the dimensions " + file.dimensions() +
                  ". --displacements needs a pointVectorField of lengths, as pointDisplacement is, "
                  "or a table with the columns id, dx, dy and dz.");
  }
  auto* names =
    vtkStringArray::SafeDownCast(grid->GetFieldData()->GetAbstractArray("SurfaceNames"));
  std::map<vtkIdType, std::array<double, 3>> found;
  std::set<vtkIdType> apart;
  std::string without;
  for (vtkIdType i = 0; names && i < names->GetNumberOfValues(); ++i)
  {
    const std::string patch = names->GetValue(i);
    vtkDataArray* faces = grid->GetCellData()->GetArray(patch.c_str());
    const auto* entry = entryOf(entries, patch);
    if (!faces || !entry || entry->type != "fixedValue" || entry->values.empty())
    {
      without += (without.empty() ? "" : ", ") + patch + (entry ? " (" + entry->type + ")" : "");
      continue;
    }
    const std::vector<vtkIdType> points = pointsOfPatch(grid, faces);
    const std::vector<double>& values = entry->values;
    if (!entry->isUniform && values.size() != 3 * points.size())
    {
      throw Failure(path + ": the patch " + patch + " has " + std::to_string(points.size()) +
                    " points in the mesh, and " + std::to_string(values.size() / 3) +
                    " values in the field.");
    }
    for (std::size_t k = 0; k < points.size(); ++k)
    {
      const double* value = values.data() + (entry->isUniform ? 0 : 3 * k);
      std::array<double, 3>& old = found[points[k]];
      const double size = vtkMath::Norm(old.data());
      if (size == 0)
      {
        std::copy(value, value + 3, old.begin());
      }
      else if (vtkMath::Norm(value) > 0 &&
               vtkMath::Distance2BetweenPoints(value, old.data()) > 1e-12 * size * size)
      {
        apart.insert(points[k]);
      }
    }
  }
  if (!without.empty())
  {
    std::cerr << "morph-mesh: warning: " << path << " has no fixedValue for the patches " << without
              << ". Their nodes stay, or move with the interior with --free-unnamed-boundary.\n";
  }
  if (!apart.empty())
  {
    std::cerr << "morph-mesh: warning: " << path << ": patches move " << apart.size()
              << " nodes that they share differently, the first of them node " << *apart.begin()
              << ". The first patch of the mesh is followed.\n";
  }
  return { found.begin(), found.end() };
}

struct SurfaceSums
{
  vtkIdType Faces = 0;
  bool IsInner = true;            ///< all of them
  double Area = 0;                ///< of a plane mesh: length
  double Center[3] = { 0, 0, 0 }; ///< times Area
};

/// Adds a polygon, as the triangles about its first point, or an edge, whose length counts.
void addPolygon(vtkPolyData* boundary, vtkIdList* corners, SurfaceSums& sums)
{
  ++sums.Faces;
  double a[3], b[3], c[3], ab[3], ac[3], normal[3];
  boundary->GetPoint(corners->GetId(0), a);
  if (corners->GetNumberOfIds() == 2)
  {
    boundary->GetPoint(corners->GetId(1), b);
    const double length = std::sqrt(vtkMath::Distance2BetweenPoints(a, b));
    sums.Area += length;
    for (int j = 0; j < 3; ++j)
    {
      sums.Center[j] += length * (a[j] + b[j]) / 2;
    }
  }
  for (vtkIdType i = 2; i < corners->GetNumberOfIds(); ++i)
  {
    boundary->GetPoint(corners->GetId(i - 1), b);
    boundary->GetPoint(corners->GetId(i), c);
    vtkMath::Subtract(b, a, ab);
    vtkMath::Subtract(c, a, ac);
    vtkMath::Cross(ab, ac, normal);
    const double area = vtkMath::Norm(normal) / 2;
    sums.Area += area;
    for (int j = 0; j < 3; ++j)
    {
      sums.Center[j] += area * (a[j] + b[j] + c[j]) / 3;
    }
  }
}

/// What --fixed-zones, --rigid-zones and --soft-zones can name: "zone rotor: 64 cells".
void printZones(vtkBoundaryDisplacement* filter)
{
  vtkStringArray* sizes = filter->GetZoneSizes();
  for (vtkIdType i = 0; i + 2 < sizes->GetNumberOfValues(); i += 3)
  {
    const bool isOfCells = !sizes->GetValue(i + 1).empty();
    std::cout << "zone " << sizes->GetValue(i) << ": "
              << (isOfCells ? sizes->GetValue(i + 1) + " cells" : sizes->GetValue(i + 2) + " nodes")
              << "\n";
  }
}

}

void readMotion(vtkDisplacementAlgorithm* filter, const Arguments& arguments)
{
  if (!arguments.target.empty())
  {
    filter->SetTargetData(readTarget(arguments.target));
  }
  if (!arguments.handles.empty())
  {
    for (const NumberLine& line :
      readNumbers(arguments.handles, { "x", "y", "z", "dx", "dy", "dz", "?radius" }))
    {
      filter->AddHandle(line.numbers.data());
    }
  }
  if (!arguments.lattice.empty())
  {
    for (const NumberLine& line :
      readNumbers(arguments.lattice, { "i", "j", "k", "dx", "dy", "dz" }))
    {
      filter->AddLatticeDisplacement(line.numbers.data());
    }
  }
  if (!arguments.field.empty())
  {
    filter->SetFieldData(readField(arguments.field, arguments.timeStep));
  }
}

vtkSmartPointer<vtkPointSet> readBoundary(
  vtkUnstructuredGrid* grid, const std::string& path, bool isDisplacement, int timeStep)
{
  vtkSmartPointer<vtkPointSet> boundary = readPoints(path, timeStep);
  vtkDataArray* numbers = numbersOf(boundary);
  if (!numbers || !numbersOf(grid) || boundary->GetPointData()->HasArray("MorphPointId") ||
      boundary->GetNumberOfPoints() != grid->GetNumberOfPoints())
  {
    return boundary;
  }
  // A copy of the mesh, whose points another program may have brought into another order.
  const auto points = pointOfNumber(numbersOf(grid));
  vtkNew<vtkIdTypeArray> ids;
  ids->SetName("MorphPointId");
  for (vtkIdType i = 0; i < numbers->GetNumberOfTuples(); ++i)
  {
    const auto found = points.find(static_cast<vtkIdType>(numbers->GetComponent(i, 0)));
    if (found == points.end())
    {
      std::ostringstream number;
      number << numbers->GetComponent(i, 0);
      throw Failure(path + " has as many points as the grid, but other node numbers, such as " +
                    number.str() + ". Give a copy of the grid, or remove the array " +
                    numbers->GetName() + ".");
    }
    ids->InsertNextValue(found->second);
  }
  const vtkIdType* first = ids->GetPointer(0);
  if (!std::is_sorted(first, first + ids->GetNumberOfTuples()))
  {
    std::cerr << "morph-mesh: warning: the points of " << path
              << " are in another order than those of the grid. They are matched by the array "
              << numbers->GetName() << (isDisplacement ? "" : ", the outer nodes alone") << ".\n";
  }
  if (isDisplacement) // of each node, of the inner ones too
  {
    boundary->GetPointData()->AddArray(ids);
    return boundary;
  }
  std::vector<vtkIdType> pointOf(points.size()); // the inner nodes' places are arbitrary
  for (vtkIdType i = 0; i < ids->GetNumberOfTuples(); ++i)
  {
    pointOf[ids->GetValue(i)] = i;
  }
  vtkNew<vtkExtractMorphBoundary> outer;
  outer->SetInputData(grid);
  outer->Update();
  vtkPolyData* surface = outer->GetOutput();
  vtkDataArray* nodes = surface->GetPointData()->GetArray("MorphPointId");
  vtkNew<vtkPoints> moved;
  moved->SetDataType(boundary->GetPoints()->GetDataType());
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
  {
    moved->InsertNextPoint(
      boundary->GetPoint(pointOf[static_cast<vtkIdType>(nodes->GetComponent(i, 0))]));
  }
  surface->SetPoints(moved);
  return surface;
}

vtkSmartPointer<vtkAlgorithm> readDisplacements(
  vtkUnstructuredGrid* grid, const std::string& path, bool nodeNumbers)
{
  const std::string head = io::readHead(path, 4096);
  const bool isField =
    head.find("FoamFile") != std::string::npos || head.rfind("\x1f\x8b", 0) == 0; // packed
  vtkNew<vtkPoints> places;
  places->SetDataTypeToDouble();
  vtkNew<vtkIdTypeArray> ids;
  ids->SetName("MorphPointId");
  vtkNew<vtkDoubleArray> vectors;
  vectors->SetName(DisplacementName);
  vectors->SetNumberOfComponents(3);
  for (const auto& [id, vector] :
    isField ? displacementsOfField(grid, path) : displacementsOfTable(grid, path, nodeNumbers))
  {
    ids->InsertNextValue(id);
    places->InsertNextPoint(grid->GetPoint(id));
    vectors->InsertNextTuple(vector.data());
  }
  if (ids->GetNumberOfTuples() == 0)
  {
    throw Failure(path + " has no node that moves.");
  }
  vtkNew<vtkPolyData> boundary;
  boundary->SetPoints(places);
  boundary->GetPointData()->AddArray(ids);
  boundary->GetPointData()->AddArray(vectors);
  auto source = vtkSmartPointer<vtkTrivialProducer>::New();
  source->SetOutput(boundary);
  return source;
}

void printTargetDistances(vtkDataObject* boundary)
{
  vtkPointData* arrays = vtkPointSet::SafeDownCast(boundary)->GetPointData();
  for (const auto& [name, when] :
    { std::pair{ "TargetDistanceBefore", "before" }, std::pair{ "TargetDistance", "after" } })
  {
    vtkDataArray* distances = arrays->GetArray(name);
    double largest = 0, sum = 0;
    vtkIdType count = 0;
    for (vtkIdType i = 0; distances && i < distances->GetNumberOfTuples(); ++i)
    {
      const double distance = distances->GetComponent(i, 0);
      if (std::isfinite(distance)) // NaN where nodes do not move
      {
        largest = std::max(largest, distance);
        sum += distance;
        ++count;
      }
    }
    std::cout << "distance from the target " << when << ": maximum " << largest << ", mean "
              << (count > 0 ? sum / static_cast<double>(count) : 0) << "\n";
  }
}

void printSurfaces(vtkUnstructuredGrid* grid, const std::string& path, int threads)
{
  vtkNew<vtkBoundaryDisplacement> filter;
  filter->SetInputData(grid);
  filter->SetMovingToNothing();
  filter->SetNumberOfThreads(threads);
  Messages messages(filter);
  filter->UpdateInformation();
  vtkStringArray* sizes = filter->GetSurfaceSizes();
  std::vector<std::string> inside; // which are in the output only if they are asked for
  for (vtkIdType i = 0; i + 2 < sizes->GetNumberOfValues(); i += 3)
  {
    if (sizes->GetValue(i + 1).find("inner") != std::string::npos)
    {
      inside.push_back(sizes->GetValue(i));
    }
  }
  for (const std::string& name : inside)
  {
    filter->AddFixedSurface(name.c_str());
  }
  messages.update("Cannot list the surfaces of " + path);
  vtkPolyData* boundary = filter->GetOutput();
  vtkDataArray* surfaces = boundary->GetCellData()->GetArray("GeometryId");
  vtkDataArray* inner = boundary->GetCellData()->GetArray("Inner");
  // The edges of a plane mesh come as ribbons: one side of them is the mesh's, with its ids.
  vtkDataArray* ids = boundary->GetPointData()->GetArray("MorphPointId");
  const auto isImage = [&](vtkIdType point)
  { return static_cast<vtkIdType>(ids->GetComponent(point, 0)) >= grid->GetNumberOfPoints(); };
  bool isPlane = false;
  for (vtkIdType i = 0; i < boundary->GetNumberOfPoints(); ++i)
  {
    isPlane = isPlane || isImage(i);
  }
  auto* names =
    vtkStringArray::SafeDownCast(boundary->GetFieldData()->GetAbstractArray("SurfaceNames"));
  std::vector<std::pair<std::string, SurfaceSums>> named;
  for (vtkIdType i = 0; names && i < names->GetNumberOfValues(); ++i)
  {
    named.push_back({ names->GetValue(i), SurfaceSums() });
  }
  std::map<vtkIdType, SurfaceSums> sums;
  vtkNew<vtkIdList> corners;
  for (vtkIdType face = 0; face < boundary->GetNumberOfCells(); ++face)
  {
    boundary->GetCellPoints(face, corners);
    for (vtkIdType i = corners->GetNumberOfIds() - 1; isPlane && i >= 0; --i)
    {
      if (isImage(corners->GetId(i)))
      {
        corners->DeleteId(corners->GetId(i));
      }
    }
    if (isPlane && corners->GetNumberOfIds() != 2)
    {
      continue; // of a quadratic edge, between its halves
    }
    const auto add = [&](SurfaceSums& sum)
    {
      addPolygon(boundary, corners, sum);
      sum.IsInner = sum.IsInner && inner && inner->GetComponent(face, 0) != 0;
    };
    add(sums[static_cast<vtkIdType>(surfaces->GetComponent(face, 0))]);
    for (auto& [name, sum] : named)
    {
      if (boundary->GetCellData()->GetArray(name.c_str())->GetComponent(face, 0) != 0)
      {
        add(sum);
      }
    }
  }
  for (const auto& [id, sum] : sums)
  {
    const std::string name = "Surface " + std::to_string(id);
    if (filter->GetSurfaceList()->ArrayExists(name.c_str()))
    {
      named.push_back({ name, sum });
    }
  }
  std::cout << std::left << std::setw(14) << "name" << std::right << std::setw(10) << "faces"
            << std::setw(14) << (isPlane ? "length" : "area") << "  center\n";
  const double rounding = 1e-12 * boundary->GetLength();
  for (const auto& [name, sum] : named)
  {
    const double area = sum.Area > 0 ? sum.Area : 1;
    const auto center = [&, &sum = sum](int axis)
    { return std::abs(sum.Center[axis] / area) > rounding ? sum.Center[axis] / area : 0; };
    std::cout << std::left << std::setw(14) << name << std::right << std::setw(10) << sum.Faces
              << std::setw(14) << sum.Area << "  " << center(0) << ", " << center(1) << ", "
              << center(2) << (sum.IsInner && sum.Faces > 0 ? "  inner" : "") << "\n";
  }
  printZones(filter);
}
}
