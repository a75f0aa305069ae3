// SPDX-License-Identifier: BSD-3-Clause
#include "Boundaries.h"

#include "Arguments.h"
#include "Files.h"
#include "Messages.h"

#include <vtkBoundaryDisplacement.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkMath.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkTrivialProducer.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <map>
#include <sstream>
#include <vector>

namespace morph_mesh
{
namespace
{
std::vector<std::string> fieldsOf(const std::string& line)
{
  std::vector<std::string> fields;
  std::istringstream text(line);
  for (std::string field; std::getline(text, field, ',');)
  {
    const auto first = field.find_first_not_of(" \t\r\"");
    const auto last = field.find_last_not_of(" \t\r\"");
    fields.push_back(first == std::string::npos ? "" : field.substr(first, last - first + 1));
  }
  return fields;
}

/// The places of id, dx, dy and dz in a line.
std::array<std::size_t, 4> columnsOf(const std::string& header, const std::string& path)
{
  const std::vector<std::string> names = fieldsOf(header);
  std::array<std::size_t, 4> columns = {};
  const char* const wanted[] = { "id", "dx", "dy", "dz" };
  for (std::size_t i = 0; i < columns.size(); ++i)
  {
    const auto at = std::find(names.begin(), names.end(), wanted[i]);
    if (at == names.end())
    {
      throw Failure(path + ", line 1: there is no column " + wanted[i] +
                    ". The columns id, dx, dy and dz are needed.");
    }
    columns[i] = static_cast<std::size_t>(at - names.begin());
  }
  return columns;
}

/// The point of each of the file's node numbers.
std::map<vtkIdType, vtkIdType> pointOfNumber(vtkUnstructuredGrid* grid)
{
  vtkDataArray* numbers = grid->GetPointData()->GetGlobalIds();
  if (!numbers)
  {
    numbers = grid->GetPointData()->GetArray("GlobalNodeId"); // Exodus II, by VTK's reader
  }
  if (!numbers)
  {
    throw Failure("The grid's file has no node numbers: leave --node-numbers out, and give 0-based "
                  "point ids.");
  }
  std::map<vtkIdType, vtkIdType> points;
  for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i)
  {
    points.emplace(static_cast<vtkIdType>(numbers->GetComponent(i, 0)), i);
  }
  return points;
}

std::array<double, 4> numbersOf(
  const std::string& line, const std::array<std::size_t, 4>& columns, const std::string& where)
{
  const std::vector<std::string> fields = fieldsOf(line);
  std::array<double, 4> numbers = {};
  for (std::size_t i = 0; i < 4; ++i)
  {
    const std::string text = columns[i] < fields.size() ? fields[columns[i]] : "";
    char* end = nullptr;
    numbers[i] = std::strtod(text.c_str(), &end);
    if (text.empty() || *end != '\0' || !std::isfinite(numbers[i]))
    {
      throw Failure(where + "'" + text + "' is no number.");
    }
  }
  return numbers;
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

struct SurfaceSums
{
  vtkIdType Faces = 0;
  double Area = 0;
  double Center[3] = { 0, 0, 0 }; ///< times Area
};

/// Adds a polygon, as the triangles about its first point.
void addPolygon(vtkPolyData* boundary, vtkIdList* corners, SurfaceSums& sums)
{
  ++sums.Faces;
  double a[3], b[3], c[3], ab[3], ac[3], normal[3];
  boundary->GetPoint(corners->GetId(0), a);
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
}

vtkSmartPointer<vtkAlgorithm> makeDisplacement(
  vtkUnstructuredGrid* grid, const Motion& motion, int threads)
{
  auto filter = vtkSmartPointer<vtkBoundaryDisplacement>::New();
  filter->SetInputData(grid);
  filter->SetMovingToPatches();
  for (const std::string& name : motion.moving)
  {
    filter->AddPatch(name.c_str());
  }
  for (const std::string& name : motion.fixed)
  {
    filter->AddHeldPatch(name.c_str());
  }
  for (const std::string& name : motion.sliding)
  {
    filter->AddSlidingPatch(name.c_str());
  }
  for (const std::string& name : motion.free)
  {
    filter->AddFreePatch(name.c_str());
  }
  for (const std::string& name : motion.frozen)
  {
    filter->AddFrozenZone(name.c_str());
  }
  for (const std::string& name : motion.rigid)
  {
    filter->AddRigidZone(name.c_str());
  }
  filter->SetKeepLayers(motion.keepLayers);
  if (!motion.target.empty())
  {
    filter->SetMotionToTarget();
    filter->SetTargetData(readTarget(motion.target));
    filter->SetAlignTarget(motion.align);
  }
  else if (motion.radius != 0)
  {
    filter->SetMotionToRadius();
    filter->SetRadiusChange(motion.radius);
  }
  else
  {
    filter->SetMotionToPlacement();
    filter->SetTranslation(motion.translation.data());
    filter->SetRotation(motion.rotation.data());
    filter->SetScale(motion.scale.data());
    filter->SetAutoCenter(!motion.hasCenter);
    filter->SetCenter(motion.center.data());
  }
  filter->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  filter->SetNumberOfThreads(threads);
  return filter;
}

vtkSmartPointer<vtkAlgorithm> readDisplacements(
  vtkUnstructuredGrid* grid, const std::string& path, bool nodeNumbers)
{
  std::ifstream file(path);
  std::string line;
  if (!std::getline(file, line))
  {
    throw Failure("Cannot read " + path + ", or it is empty.");
  }
  const std::array<std::size_t, 4> columns = columnsOf(line, path);
  const std::map<vtkIdType, vtkIdType> points =
    nodeNumbers ? pointOfNumber(grid) : std::map<vtkIdType, vtkIdType>();
  vtkNew<vtkPoints> places;
  places->SetDataTypeToDouble();
  vtkNew<vtkIdTypeArray> ids;
  ids->SetName("MorphPointId");
  vtkNew<vtkDoubleArray> vectors;
  vectors->SetName(DisplacementName);
  vectors->SetNumberOfComponents(3);
  for (int number = 2; std::getline(file, line); ++number)
  {
    if (line.find_first_not_of(" \t\r") == std::string::npos)
    {
      continue;
    }
    const std::string where = path + ", line " + std::to_string(number) + ": ";
    const std::array<double, 4> values = numbersOf(line, columns, where);
    const auto given = static_cast<vtkIdType>(values[0]);
    const auto found = points.find(given);
    const vtkIdType id = !nodeNumbers ? given : found == points.end() ? -1 : found->second;
    if (id < 0 || id >= grid->GetNumberOfPoints() || values[0] != std::floor(values[0]))
    {
      throw Failure(where + "the grid has no node '" + fieldsOf(line)[columns[0]] + "'.");
    }
    ids->InsertNextValue(id);
    places->InsertNextPoint(grid->GetPoint(id));
    vectors->InsertNextTuple3(values[1], values[2], values[3]);
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
  messages.update("Cannot list the surfaces of " + path);
  vtkPolyData* boundary = filter->GetOutput();
  vtkDataArray* surfaces = boundary->GetCellData()->GetArray("GeometryId");
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
    addPolygon(boundary, corners, sums[static_cast<vtkIdType>(surfaces->GetComponent(face, 0))]);
    for (auto& [name, sum] : named)
    {
      if (boundary->GetCellData()->GetArray(name.c_str())->GetComponent(face, 0) != 0)
      {
        addPolygon(boundary, corners, sum);
      }
    }
  }
  for (const auto& [id, sum] : sums)
  {
    named.push_back({ "Surface " + std::to_string(id), sum });
  }
  std::cout << std::left << std::setw(14) << "name" << std::right << std::setw(10) << "faces"
            << std::setw(14) << "area"
            << "  centre\n";
  for (const auto& [name, sum] : named)
  {
    const double area = sum.Area > 0 ? sum.Area : 1;
    std::cout << std::left << std::setw(14) << name << std::right << std::setw(10) << sum.Faces
              << std::setw(14) << sum.Area << "  " << sum.Center[0] / area << ", "
              << sum.Center[1] / area << ", " << sum.Center[2] / area << "\n";
  }
}
}
