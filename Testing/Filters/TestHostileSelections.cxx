// SPDX-License-Identifier: BSD-3-Clause
// Selections that VTK's extractor must not see as they are: one error each, and no crash.
#include "DisplacedBoundaries.h"
#include "TestGrids.h"

#include <vtkDoubleArray.h>
#include <vtkIdTypeArray.h>
#include <vtkInformation.h>
#include <vtkNew.h>
#include <vtkSelection.h>
#include <vtkSelectionNode.h>
#include <vtkStringArray.h>

#include <gtest/gtest.h>

namespace
{
vtkSmartPointer<vtkSelection> selection(int field, int content, vtkAbstractArray* list)
{
  vtkNew<vtkSelectionNode> node;
  node->SetFieldType(field);
  node->SetContentType(content);
  node->SetQueryString("x > 1");
  if (list)
  {
    node->SetSelectionList(list);
  }
  auto result = vtkSmartPointer<vtkSelection>::New();
  result->AddNode(node);
  return result;
}

vtkSmartPointer<vtkDoubleArray> numbers(int components, const std::vector<double>& values)
{
  auto array = vtkSmartPointer<vtkDoubleArray>::New();
  array->SetNumberOfComponents(components);
  for (const double value : values)
  {
    array->InsertNextValue(value);
  }
  return array;
}
}

class HostileSelections : public testing::TestWithParam<int>
{
};

INSTANTIATE_TEST_SUITE_P(Fields, HostileSelections,
  testing::Values(vtkSelectionNode::POINT, vtkSelectionNode::CELL, vtkSelectionNode::ROW, -1, 99));

TEST_P(HostileSelections, DoNotCrash)
{
  vtkNew<vtkStringArray> text;
  text->InsertNextValue("here");
  const std::vector<vtkSmartPointer<vtkAbstractArray>> lists = { nullptr, text.Get(),
    numbers(1, {}), numbers(1, { NAN, 1e300, -1e300, 0.5 }), numbers(1, { -1, 64, 1e6, 3 }),
    numbers(2, { 0, 1, 2, 3 }), numbers(3, { 1, 1, 1, NAN, NAN, NAN }),
    numbers(5, { 1, 2, 3, 4, 5 }) };
  auto grid = grids::hexes(3);
  for (int content = -1; content <= 13; ++content)
  {
    for (std::size_t i = 0; i < lists.size(); ++i)
    {
      SCOPED_TRACE(std::to_string(content) + ", list " + std::to_string(i));
      auto filter = displaced::make(grid);
      filter->SetMovingToSelection();
      grids::moveBy(filter, 1, 0, 0);
      filter->SetSelectionData(selection(this->GetParam(), content, lists[i]));
      const grids::Run listener(filter);
      const bool moved = filter->GetMovingPoints() > 0;
      EXPECT_EQ(listener.Errors.size(), moved ? 0u : 1u);
    }
  }
}
