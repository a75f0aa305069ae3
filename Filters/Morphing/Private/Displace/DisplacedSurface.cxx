// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Displace/DisplacedSurface.h"

#include "Private/Data/Directions.h"
#include "Private/Data/GridMesh.h"
#include "Private/Data/Output.h"
#include "Private/Data/Surface.h"
#include "Private/Displace/InputBoundary.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSignedCharArray.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <array>

namespace morph::filters
{
namespace
{
using morph::Index;

template <typename Array, typename Value>
void writePoints(const morph::Points& rest, const morph::Points& moved, vtkPolyData* output)
{
  const auto make = [&](const char* name)
  {
    auto array = vtkSmartPointer<Array>::New();
    array->SetName(name);
    array->SetNumberOfComponents(3);
    array->SetNumberOfTuples(moved.rows());
    return array;
  };
  auto coordinates = make("Points");
  auto displacement = make("BoundaryDisplacement");
  using Written = Eigen::Map<Eigen::Matrix<Value, Eigen::Dynamic, 3, Eigen::RowMajor>>;
  Written coordinate(coordinates->GetPointer(0), moved.rows(), 3);
  coordinate = moved.template cast<Value>();
  Written(displacement->GetPointer(0), moved.rows(), 3) =
    (coordinate.template cast<double>() - rest).template cast<Value>();
  vtkNew<vtkPoints> points;
  points->SetData(coordinates);
  output->SetPoints(points);
  Directions::RemoveNormals(output);
  output->GetPointData()->AddArray(displacement);
  output->GetPointData()->SetActiveVectors("BoundaryDisplacement");
}

/// Role of each point, and of each cell: that of its points or, where those differ, Follows, unless
/// none of them moves.
void writeRoles(
  const std::vector<Index>& nodes, const std::vector<signed char>& roleOfNode, vtkPolyData* output)
{
  const auto make = [](vtkIdType count)
  {
    auto roles = vtkSmartPointer<vtkSignedCharArray>::New();
    roles->SetName("Role");
    roles->SetNumberOfValues(count);
    return roles;
  };
  auto ofPoints = make(output->GetNumberOfPoints());
  std::transform(nodes.begin(), nodes.end(), ofPoints->GetPointer(0),
    [&roleOfNode](Index node) { return roleOfNode[node]; });
  vtkCellArray* faces = output->GetPolys();
  auto ofCells = make(faces->GetNumberOfCells());
  vtkNew<vtkIdList> points;
  for (vtkIdType cell = 0; cell < faces->GetNumberOfCells(); ++cell)
  {
    faces->GetCellAtId(cell, points);
    std::array<bool, Surroundings::IsLayer + 1> has = {};
    for (vtkIdType k = 0; k < points->GetNumberOfIds(); ++k)
    {
      has[ofPoints->GetValue(points->GetId(k))] = true;
    }
    const bool isMixed = std::count(has.begin(), has.end(), true) > 1;
    const bool isMoving = has[Surroundings::Moves] || has[Surroundings::Follows];
    const auto only =
      static_cast<signed char>(std::find(has.begin(), has.end(), true) - has.begin());
    const signed char mixed = isMoving ? Surroundings::Follows : Surroundings::Stays;
    ofCells->SetValue(cell, isMixed || only > Surroundings::IsFree ? mixed : only);
  }
  output->GetPointData()->AddArray(ofPoints);
  output->GetCellData()->AddArray(ofCells);
  // Viewers prefer active point scalars, and would blend the categories.
  output->GetPointData()->SetActiveScalars(nullptr);
  output->GetCellData()->SetActiveScalars("Role");
}

/// Marks free nodes. Those that an earlier filter has freed stay free where they stay.
void writeFree(
  const std::vector<Index>& nodes, const std::vector<signed char>& roleOfNode, vtkPolyData* output)
{
  vtkDataArray* before = output->GetPointData()->GetArray(Surface::FreeName);
  const bool frees = std::find(roleOfNode.begin(), roleOfNode.end(),
                       static_cast<signed char>(Surroundings::IsFree)) != roleOfNode.end();
  if (!before && !frees)
  {
    return;
  }
  vtkNew<vtkUnsignedCharArray> free;
  free->SetName(Surface::FreeName);
  bool any = false;
  for (std::size_t i = 0; i < nodes.size(); ++i)
  {
    const auto point = static_cast<vtkIdType>(i);
    const bool wasFree =
      before && point < before->GetNumberOfTuples() && before->GetComponent(point, 0) != 0;
    const signed char role = roleOfNode[nodes[i]];
    const bool isFree = role == Surroundings::IsFree || (wasFree && role == Surroundings::Stays);
    free->InsertNextValue(isFree);
    any = any || isFree;
  }
  output->GetPointData()->RemoveArray(Surface::FreeName);
  if (any)
  {
    output->GetPointData()->AddArray(free);
  }
}
}

namespace DisplacedSurface
{
void Write(const InputBoundary& model, const Surroundings::Result& result, vtkPointSet* input,
  int precision, vtkPolyData* output)
{
  const bool isFloat = Output::IsFloat(input, precision);
  const morph::Points moved = result.moved(model.NodeOfPoint(), morph::allColumns);
  const morph::Points rest =
    GridMesh::FromVectors(model.Surface()->GetPointData()->GetArray(Surface::RestName));
  Output::RequireWritable(rest, moved, isFloat, "the boundary's nodes", &model.NodeOfPoint());
  output->ShallowCopy(model.Surface());
  (isFloat ? writePoints<vtkFloatArray, float> : writePoints<vtkDoubleArray, double>)(rest, moved,
    output);
  writeRoles(model.NodeOfPoint(), result.roles, output);
  writeFree(model.NodeOfPoint(), result.roles, output);
}
}
}
