// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Displace/InnerPoints.h"

#include "Private/Data/Geometry.h"
#include "Private/Data/Surface.h"

#include <vtkAbstractArray.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include <string>

namespace morph::filters
{
namespace
{
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

namespace InnerPoints
{
void Append(vtkUnstructuredGrid* grid, const std::vector<morph::Index>& nodes,
  const morph::Points& rest, const morph::Points& moved, const std::vector<signed char>& roles,
  vtkPolyData* output)
{
  if (nodes.empty())
  {
    return;
  }
  const vtkIdType before = output->GetNumberOfPoints();
  const vtkIdType all = before + static_cast<vtkIdType>(nodes.size());
  vtkNew<vtkPoints> points;
  points->SetDataType(output->GetPoints()->GetDataType());
  points->SetNumberOfPoints(all);
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
