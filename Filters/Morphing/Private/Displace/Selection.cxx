// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Displace/Selection.h"

#include "Support/Error.h"

#include <vtkAbstractArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataObject.h>
#include <vtkDataSet.h>
#include <vtkExtractSelection.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSelection.h>
#include <vtkSelectionNode.h>
#include <vtkSmartPointer.h>

#include <string>

namespace morph::filters
{
namespace
{
/// VTK's name for the array that says what is inside a selection.
constexpr const char* InsideName = "vtkInsidedness";
const std::string OwnExtractor = "vtkExtractSelection";

/// Throws where VTK's extractor would crash, since it does not check its input. A node without a
/// list, with a list of text instead of numbers, or of an unknown kind, ends in an assertion or in
/// memory outside its arrays.
void requireUsable(vtkSelectionNode* node, vtkExtractSelection* extractor)
{
  vtkAbstractArray* list = node->GetSelectionList();
  auto* numbers = vtkDataArray::SafeDownCast(list);
  const int components = list ? list->GetNumberOfComponents() : 0;
  bool isUsable = false;
  switch (node->GetContentType())
  {
    case vtkSelectionNode::INDICES:
    case vtkSelectionNode::GLOBALIDS:
    case vtkSelectionNode::THRESHOLDS:
      isUsable = numbers && components <= 2;
      break;
    case vtkSelectionNode::PEDIGREEIDS:
    case vtkSelectionNode::VALUES:
      isUsable = list && components <= 2;
      break;
    case vtkSelectionNode::LOCATIONS:
      isUsable = numbers && components == 3;
      break;
    case vtkSelectionNode::FRUSTUM:
      isUsable = numbers && numbers->GetNumberOfValues() >= 32;
      break;
    case vtkSelectionNode::QUERY: // known to ParaView's extractor, and not to VTK's own
      isUsable = node->GetQueryString() && extractor->GetClassName() != OwnExtractor;
      break;
    default:
      break;
  }
  if (!isUsable)
  {
    throw morph::Error("The selection cannot be used: its kind of content (" +
                       std::to_string(node->GetContentType()) +
                       ") is not known here, or its list of values is missing or does not fit. "
                       "Select points or cells again.");
  }
}

/// vtkSelectionNode::POINT or CELL, which all of the selection's nodes have to be.
int fieldType(vtkSelection* selection, vtkExtractSelection* extractor)
{
  if (!selection || selection->GetNumberOfNodes() == 0)
  {
    throw morph::Error("Nothing is selected. Select points or cells of the input, and copy the "
                       "active selection, or choose in another way what moves.");
  }
  const int type = selection->GetNode(0)->GetFieldType();
  for (unsigned int i = 0; i < selection->GetNumberOfNodes(); ++i)
  {
    const int other = selection->GetNode(i)->GetFieldType();
    if (other != type || (type != vtkSelectionNode::POINT && type != vtkSelectionNode::CELL))
    {
      throw morph::Error("The selection is of neither points nor cells, or of both. Select either "
                         "points or cells of the input.");
    }
    requireUsable(selection->GetNode(i), extractor);
  }
  return type;
}

/// Whether each of `count` points or cells is inside.
std::vector<std::uint8_t> evaluate(vtkDataSet* input, vtkSelection* selection,
  vtkExtractSelection* extractor, bool byPoints, vtkIdType count)
{
  auto copy = vtkSmartPointer<vtkDataSet>::Take(input->NewInstance());
  copy->ShallowCopy(input); // apart from the pipeline, and without what an earlier selection left
  copy->GetPointData()->RemoveArray(InsideName);
  copy->GetCellData()->RemoveArray(InsideName);
  extractor->PreserveTopologyOn();
  extractor->SetInputData(0, copy);
  extractor->SetInputData(1, selection);
  extractor->Update();
  vtkSmartPointer<vtkDataArray> inside;
  auto* output = vtkDataSet::SafeDownCast(extractor->GetOutputDataObject(0));
  if (output)
  {
    const int type = byPoints ? vtkDataObject::POINT : vtkDataObject::CELL;
    inside = output->GetAttributesAsFieldData(type)->GetArray(InsideName);
  }
  // An output without points is VTK's way to say that nothing is inside.
  const bool isNone = output && !inside && output->GetNumberOfPoints() == 0;
  extractor->SetInputData(0, nullptr);
  extractor->SetInputData(1, nullptr);
  if (!isNone && (!inside || inside->GetNumberOfTuples() != count))
  {
    throw morph::Error("The selection cannot be evaluated on the input. Select points or cells of "
                       "the input itself.");
  }
  std::vector<std::uint8_t> isInside(count, 0);
  for (vtkIdType i = 0; inside && i < count; ++i)
  {
    isInside[i] = inside->GetComponent(i, 0) > 0;
  }
  return isInside;
}
}

namespace Selection
{
std::vector<std::uint8_t> Points(
  vtkDataSet* input, vtkSelection* selection, vtkExtractSelection* extractor)
{
  const bool byPoints = fieldType(selection, extractor) == vtkSelectionNode::POINT;
  const vtkIdType count = byPoints ? input->GetNumberOfPoints() : input->GetNumberOfCells();
  std::vector<std::uint8_t> isInside = evaluate(input, selection, extractor, byPoints, count);
  if (byPoints)
  {
    return isInside;
  }
  std::vector<std::uint8_t> isSelected(input->GetNumberOfPoints(), 0);
  vtkNew<vtkIdList> points;
  for (vtkIdType i = 0; i < count; ++i)
  {
    if (isInside[i])
    {
      input->GetCellPoints(i, points);
      for (vtkIdType k = 0; k < points->GetNumberOfIds(); ++k)
      {
        isSelected[points->GetId(k)] = 1;
      }
    }
  }
  return isSelected;
}
}
}
