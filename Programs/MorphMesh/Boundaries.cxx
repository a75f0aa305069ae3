// SPDX-License-Identifier: BSD-3-Clause
#include "Boundaries.h"

#include "Arguments.h"
#include "Files.h"
#include "Messages.h"
#include "NumberColumns.h"

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
#include <cmath>
#include <iomanip>
#include <iostream>
#include <map>
#include <sstream>
#include <vector>

namespace morph_mesh
{
namespace
{
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

vtkSmartPointer<vtkPolyData> readTarget(const std::string& path)
{
  vtkSmartPointer<vtkPolyData> surface = vtkPolyData::SafeDownCast(readPoints(path));
  if (!surface)
  {
    throw Failure(path + " is no surface: --target needs one, an .stl file for instance.");
  }
  return surface;
}

/// The handles, or the lattice, of the motion's file.
void setControlPoints(vtkBoundaryDisplacement* filter, const Motion& motion)
{
  if (!motion.handles.empty())
  {
    filter->SetMotionToHandles();
    for (const NumberLine& line :
      readNumbers(motion.handles, { "x", "y", "z", "dx", "dy", "dz", "?radius" }))
    {
      filter->AddHandle(line.numbers.data());
    }
    return;
  }
  filter->SetMotionToLattice();
  filter->SetLatticeSize(motion.latticeSize.data());
  if (motion.hasLatticeBox)
  {
    filter->AutoLatticeOff();
    filter->SetLatticeBounds(motion.latticeBox.data());
  }
  filter->SetLatticeBasis(motion.bSplines ? vtkBoundaryDisplacement::LATTICE_B_SPLINE
                                          : vtkBoundaryDisplacement::LATTICE_BERNSTEIN);
  for (const NumberLine& line : readNumbers(motion.lattice, { "i", "j", "k", "dx", "dy", "dz" }))
  {
    filter->AddLatticeDisplacement(line.numbers.data());
  }
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
  if (motion.moving.empty() && motion.byControlPoints())
  {
    filter->SetMovingToEverything();
  }
  else
  {
    filter->SetMovingToPatches();
  }
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
  filter->SetSlideRounds(motion.slideRounds);
  filter->SetSurfaceMethod(motion.surfaceMethod == "MeshSmoothing"
                             ? vtkBoundaryDisplacement::SURFACE_METHOD_MESH_SMOOTHING
                           : motion.surfaceMethod == "Smoothing"
                             ? vtkBoundaryDisplacement::SURFACE_METHOD_SMOOTHING
                             : vtkBoundaryDisplacement::SURFACE_METHOD_WEIGHTED_RESIDUAL);
  if (!motion.target.empty())
  {
    filter->SetMotionToTarget();
    filter->SetTargetData(readTarget(motion.target));
    filter->SetAlignTarget(motion.align);
    filter->SetProjectAlong(motion.projectAlong);
    filter->SetProjectVector(motion.projectVector.data());
  }
  else if (motion.byControlPoints())
  {
    setControlPoints(filter, motion);
  }
  else if (motion.radius)
  {
    filter->SetMotionToRadius();
    filter->SetRadiusChange(*motion.radius);
  }
  else
  {
    filter->SetMotionToPlacement();
    if (motion.translation)
    {
      filter->SetTranslation(motion.translation->data());
    }
    if (motion.rotation)
    {
      filter->SetRotation(motion.rotation->data());
    }
    if (motion.scale)
    {
      filter->SetScale(motion.scale->data());
    }
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
  const std::map<vtkIdType, vtkIdType> points =
    nodeNumbers ? pointOfNumber(grid) : std::map<vtkIdType, vtkIdType>();
  vtkNew<vtkPoints> places;
  places->SetDataTypeToDouble();
  vtkNew<vtkIdTypeArray> ids;
  ids->SetName("MorphPointId");
  vtkNew<vtkDoubleArray> vectors;
  vectors->SetName(DisplacementName);
  vectors->SetNumberOfComponents(3);
  for (const NumberLine& line : readNumbers(path, { "id", "dx", "dy", "dz" }))
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
