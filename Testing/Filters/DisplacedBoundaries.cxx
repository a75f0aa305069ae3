// SPDX-License-Identifier: BSD-3-Clause
#include "DisplacedBoundaries.h"

#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSelection.h>
#include <vtkSelectionNode.h>

namespace displaced
{
vtkSmartPointer<vtkBoundaryDisplacement> make(vtkDataObject* input)
{
  auto filter = vtkSmartPointer<vtkBoundaryDisplacement>::New();
  filter->SetInputDataObject(input);
  return filter;
}

morph::Points restPositions(vtkPolyData* output)
{
  return vectors(output, "RestPosition");
}

morph::Points vectors(vtkPolyData* output, const char* name)
{
  vtkDataArray* array = output->GetPointData()->GetArray(name);
  morph::Points result(array->GetNumberOfTuples(), 3);
  for (morph::Index i = 0; i < result.rows(); ++i)
  {
    for (int j = 0; j < 3; ++j)
    {
      result(i, j) = array->GetComponent(i, j);
    }
  }
  return result;
}

int role(vtkPolyData* output, vtkIdType point)
{
  return static_cast<int>(output->GetPointData()->GetArray("Role")->GetComponent(point, 0));
}

std::vector<morph::Index> nodesWhere(
  vtkPointSet* data, const std::function<bool(const grids::Row&)>& is)
{
  const morph::Points x = grids::points(data);
  std::vector<morph::Index> nodes;
  for (morph::Index i = 0; i < x.rows(); ++i)
  {
    if (is(x.row(i)))
    {
      nodes.push_back(i);
    }
  }
  return nodes;
}

std::string surfaceName(
  vtkBoundaryDisplacement* filter, const std::function<bool(const grids::Row&)>& is)
{
  auto still = grids::of<vtkBoundaryDisplacement>(filter->GetInputDataObject(0, 0));
  still->Update();
  vtkPolyData* output = still->GetOutput();
  const morph::Points rest = restPositions(output);
  vtkNew<vtkIdList> points;
  for (vtkIdType c = 0; c < output->GetNumberOfCells(); ++c)
  {
    output->GetCellPoints(c, points);
    bool all = true;
    for (vtkIdType k = 0; k < points->GetNumberOfIds(); ++k)
    {
      all = all && is(rest.row(points->GetId(k)));
    }
    if (all)
    {
      return "Surface " + std::to_string(static_cast<int>(
                            output->GetCellData()->GetArray("GeometryId")->GetComponent(c, 0)));
    }
  }
  return "no surface";
}

vtkSmartPointer<vtkBoundaryDisplacement> moving(
  vtkDataObject* input, const std::function<bool(const grids::Row&)>& is)
{
  auto filter = make(input);
  filter->SetMovingToSurfaces();
  filter->AddSurface(surfaceName(filter, is).c_str());
  return filter;
}

vtkSmartPointer<vtkSelection> indices(int fieldType, const std::vector<morph::Index>& ids)
{
  vtkNew<vtkIdTypeArray> list;
  for (morph::Index id : ids)
  {
    list->InsertNextValue(id);
  }
  vtkNew<vtkSelectionNode> node;
  node->SetContentType(vtkSelectionNode::INDICES);
  node->SetFieldType(fieldType);
  node->SetSelectionList(list);
  auto selection = vtkSmartPointer<vtkSelection>::New();
  selection->AddNode(node);
  return selection;
}

vtkSmartPointer<vtkSelection> frustum(int fieldType, const std::array<double, 6>& bounds)
{
  vtkNew<vtkDoubleArray> corners;
  corners->SetNumberOfComponents(4);
  for (int x = 0; x < 2; ++x)
  {
    // The order that vtkFrustumSelector wants.
    for (int z = 0; z < 2; ++z)
    {
      for (int y = 0; y < 2; ++y)
      {
        corners->InsertNextTuple4(bounds[x], bounds[2 + y], bounds[4 + z], 1);
      }
    }
  }
  vtkNew<vtkSelectionNode> node;
  node->SetContentType(vtkSelectionNode::FRUSTUM);
  node->SetFieldType(fieldType);
  node->SetSelectionList(corners);
  auto selection = vtkSmartPointer<vtkSelection>::New();
  selection->AddNode(node);
  return selection;
}
}
