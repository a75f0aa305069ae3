// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Displace/DisplacedSurface.h"

#include "Private/Data/Arrays.h"
#include "Private/Data/Directions.h"
#include "Private/Data/Geometry.h"
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
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <array>
#include <string>

namespace morph::filters
{
namespace
{
using morph::Index;

template <typename Array, typename Value>
void writePoints(const morph::Points& rest, const morph::Points& moved, vtkPolyData* output)
{
  auto coordinates = Arrays::Make<Array>("Points", moved.rows(), 3);
  auto displacement = Arrays::Make<Array>("BoundaryDisplacement", moved.rows(), 3);
  using Written = Eigen::Map<Eigen::Matrix<Value, Eigen::Dynamic, 3, Eigen::RowMajor>>;
  Written coordinate(coordinates->GetPointer(0), moved.rows(), 3);
  coordinate = moved.template cast<Value>();
  Written(displacement->GetPointer(0), moved.rows(), 3) =
    (coordinate.template cast<double>() - rest).template cast<Value>();
  vtkNew<vtkPoints> points;
  points->SetData(coordinates);
  output->SetPoints(points);
  Directions::RemoveNormals(output);
  Arrays::Add(displacement, output->GetPointData());
  output->GetPointData()->SetActiveVectors("BoundaryDisplacement");
}

/// Role of each point, and of each cell: that of its points or, where those differ, Follows, unless
/// none of them moves.
void writeRoles(
  const std::vector<Index>& nodes, const std::vector<signed char>& roleOfNode, vtkPolyData* output)
{
  auto ofPoints = Arrays::MakeOf<vtkSignedCharArray>(
    "Role", nodes, [&roleOfNode](Index node) { return roleOfNode[node]; });
  vtkCellArray* faces = output->GetPolys();
  auto ofCells = Arrays::Make<vtkSignedCharArray>("Role", faces->GetNumberOfCells());
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
  Arrays::Add(ofPoints, output->GetPointData());
  Arrays::Add(ofCells, output->GetCellData());
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
  auto free = Arrays::Make<vtkUnsignedCharArray>(Surface::FreeName);
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
    Arrays::Add(free, output->GetPointData());
  }
}

/// A copy of the array with room for more tuples, which are 0.
vtkSmartPointer<vtkAbstractArray> extended(vtkAbstractArray* array, vtkIdType before, vtkIdType all)
{
  auto copy = vtkSmartPointer<vtkAbstractArray>::Take(array->NewInstance());
  copy->SetName(array->GetName());
  copy->SetNumberOfComponents(array->GetNumberOfComponents());
  copy->CopyComponentNames(array);
  copy->SetNumberOfTuples(all);
  copy->InsertTuples(0, before, 0, array);
  if (auto* numbers = vtkDataArray::SafeDownCast(copy))
  {
    for (vtkIdType i = before; i < all; ++i)
    {
      for (int j = 0; j < numbers->GetNumberOfComponents(); ++j)
      {
        numbers->SetComponent(i, j, 0);
      }
    }
  }
  return copy;
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

void AppendInner(vtkUnstructuredGrid* grid, const std::vector<morph::Index>& nodes,
  const morph::Points& rest, const morph::Points& moved, const std::vector<signed char>& roles,
  vtkPolyData* output)
{
  if (nodes.empty())
  {
    return;
  }
  const vtkIdType before = output->GetNumberOfPoints();
  const vtkIdType all = before + static_cast<vtkIdType>(nodes.size());
  auto points = Arrays::MakePoints(output->GetPoints()->GetDataType(), all);
  points->GetData()->InsertTuples(0, before, 0, output->GetPoints()->GetData());
  for (vtkIdType i = before; i < all; ++i)
  {
    points->SetPoint(i, moved.row(i - before).data());
  }
  vtkPointData* data = output->GetPointData();
  for (int a = 0; a < data->GetNumberOfArrays(); ++a)
  {
    vtkAbstractArray* old = data->GetAbstractArray(a);
    const std::string name = old->GetName() ? old->GetName() : "";
    auto array = extended(old, before, all);
    vtkAbstractArray* ofGrid = grid->GetPointData()->GetAbstractArray(name.c_str());
    const bool isOfGrid = ofGrid && ofGrid->GetDataType() == array->GetDataType() &&
                          ofGrid->GetNumberOfComponents() == array->GetNumberOfComponents();
    auto* numbers = vtkDataArray::SafeDownCast(array);
    for (vtkIdType i = before; i < all; ++i)
    {
      const auto k = static_cast<std::size_t>(i - before);
      if (name == Surface::IdName)
      {
        numbers->SetComponent(i, 0, static_cast<double>(nodes[k]));
      }
      else if (name == Surface::RestName || name == "BoundaryDisplacement")
      {
        const Eigen::RowVector3d x = points->GetDataType() == VTK_FLOAT
                                       ? moved.row(i - before).cast<float>().cast<double>().eval()
                                       : moved.row(i - before).eval();
        for (int j = 0; j < 3; ++j)
        {
          const double r = rest(i - before, j);
          numbers->SetComponent(i, j, name == Surface::RestName ? r : x[j] - r);
        }
        if (name == Surface::RestName && numbers->GetNumberOfComponents() > 3)
        {
          numbers->SetComponent(i, 3, 1);
        }
      }
      else if (name == "Role")
      {
        numbers->SetComponent(i, 0, roles[k]);
      }
      else if (name == Geometry::DimensionName)
      {
        numbers->SetComponent(i, 0, 3);
      }
      else if (name == Geometry::IdName)
      {
        numbers->SetComponent(i, 0, -1);
      }
      else if (isOfGrid)
      {
        array->SetTuple(i, nodes[k], ofGrid);
      }
    }
    // Replaces the one of its name, and keeps its place among the attributes.
    const int attribute = data->IsArrayAnAttribute(a);
    data->AddArray(array);
    if (attribute >= 0)
    {
      data->SetActiveAttribute(name.c_str(), attribute);
    }
  }
  output->SetPoints(points);
}
}
}
