// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Displace/Selection.h"

#include "Private/Blocks/Blocks.h"
#include "Private/Blocks/Leaves.h"
#include "Support/Error.h"

#include <vtkAbstractArray.h>
#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkDataObject.h>
#include <vtkDataObjectTree.h>
#include <vtkDataSet.h>
#include <vtkExtractSelection.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkSelection.h>
#include <vtkSelectionNode.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include <map>
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

/// Makes `input` ready for the extractor: apart from the pipeline, and without what an earlier
/// selection left.
void forget(vtkDataSet* input)
{
  input->GetPointData()->RemoveArray(InsideName);
  input->GetCellData()->RemoveArray(InsideName);
}

/// The given extractor, or VTK's own.
vtkSmartPointer<vtkExtractSelection> orOwn(vtkExtractSelection* given)
{
  return given ? vtkSmartPointer<vtkExtractSelection>(given)
               : vtkSmartPointer<vtkExtractSelection>::New();
}

/// The extractor's output for `input`, which is the caller's own.
vtkSmartPointer<vtkDataObject> extracted(
  vtkDataObject* input, vtkSelection* selection, vtkExtractSelection* extractor)
{
  extractor->PreserveTopologyOn();
  extractor->SetInputData(0, input);
  extractor->SetInputData(1, selection);
  extractor->Update();
  vtkSmartPointer<vtkDataObject> output;
  if (vtkDataObject* data = extractor->GetOutputDataObject(0))
  {
    output.TakeReference(data->NewInstance());
    output->ShallowCopy(data);
  }
  extractor->SetInputData(0, nullptr);
  extractor->SetInputData(1, nullptr);
  return output;
}

/// Whether each of `count` points or cells is inside, as the extractor's output tells.
std::vector<std::uint8_t> insideOf(vtkDataSet* output, bool byPoints, vtkIdType count)
{
  const int type = byPoints ? vtkDataObject::POINT : vtkDataObject::CELL;
  vtkDataArray* inside =
    output ? output->GetAttributesAsFieldData(type)->GetArray(InsideName) : nullptr;
  // An output without points is VTK's way to say that nothing is inside.
  const bool isNone = output && !inside && output->GetNumberOfPoints() == 0;
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

/// Calls mark(point) for each point that is inside, or that a cell inside has.
template <typename Mark>
void markPoints(
  vtkDataSet* data, bool byPoints, const std::vector<std::uint8_t>& isInside, const Mark& mark)
{
  vtkNew<vtkIdList> points;
  for (std::size_t i = 0; i < isInside.size(); ++i)
  {
    const auto id = static_cast<vtkIdType>(i);
    if (isInside[i] && byPoints)
    {
      mark(id);
    }
    else if (isInside[i])
    {
      data->GetCellPoints(id, points);
      for (vtkIdType k = 0; k < points->GetNumberOfIds(); ++k)
      {
        mark(points->GetId(k));
      }
    }
  }
}

vtkSmartPointer<vtkSelection> selectionOf(vtkIdTypeArray* ids, int type)
{
  vtkNew<vtkSelectionNode> node;
  node->SetContentType(vtkSelectionNode::INDICES);
  node->SetFieldType(type);
  node->SetSelectionList(ids);
  auto selection = vtkSmartPointer<vtkSelection>::New();
  selection->AddNode(node);
  return selection;
}

/// The grid with more cells, which the caller adds.
vtkSmartPointer<vtkUnstructuredGrid> withRoom(vtkUnstructuredGrid* grid)
{
  auto copy = vtkSmartPointer<vtkUnstructuredGrid>::New();
  copy->SetPoints(grid->GetPoints());
  copy->Allocate(grid->GetNumberOfCells());
  vtkNew<vtkIdList> points;
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
  {
    grid->GetCellPoints(cell, points);
    // Of the cells the number and the dimension count here; a polyhedron would need its faces.
    const int type = grid->GetCellType(cell);
    copy->InsertNextCell(type == VTK_POLYHEDRON ? VTK_CONVEX_POINT_SET : type, points);
  }
  return copy;
}

/// The grid's id of a selected cell of a block; of a face that of a new cell of `shown`.
vtkIdType idOf(vtkIdType cell, const MergedBlocks::Block& block, vtkDataSet* data,
  vtkUnstructuredGrid* grid, vtkSmartPointer<vtkUnstructuredGrid>& shown)
{
  const auto place = static_cast<std::size_t>(cell);
  if (data->GetCell(cell)->GetCellDimension() == 3 && place < block.Cells.size())
  {
    return block.Cells[place];
  }
  vtkNew<vtkIdList> points;
  data->GetCellPoints(cell, points);
  for (vtkIdType k = 0; k < points->GetNumberOfIds(); ++k)
  {
    const morph::Index node = block.Nodes[static_cast<std::size_t>(points->GetId(k))];
    if (node < 0)
    {
      return -1;
    }
    points->SetId(k, node);
  }
  if (shown == grid)
  {
    shown = withRoom(grid);
  }
  return shown->InsertNextCell(data->GetCellType(cell), points);
}
}

namespace Selection
{
Inside Evaluate(vtkDataSet* input, vtkSelection* selection, vtkExtractSelection* given)
{
  const vtkSmartPointer<vtkExtractSelection> extractor = orOwn(given);
  Inside inside;
  inside.ByPoints = fieldType(selection, extractor) == vtkSelectionNode::POINT;
  const vtkIdType count = inside.ByPoints ? input->GetNumberOfPoints() : input->GetNumberOfCells();
  const auto copy = vtkSmartPointer<vtkDataSet>::Take(input->NewInstance());
  copy->ShallowCopy(input);
  forget(copy);
  const vtkSmartPointer<vtkDataObject> output = extracted(copy, selection, extractor);
  inside.Flags = insideOf(vtkDataSet::SafeDownCast(output), inside.ByPoints, count);
  return inside;
}

std::vector<std::uint8_t> Points(
  vtkDataSet* input, vtkSelection* selection, vtkExtractSelection* extractor)
{
  const Inside inside = Evaluate(input, selection, extractor);
  std::vector<std::uint8_t> isSelected(input->GetNumberOfPoints(), 0);
  markPoints(input, inside.ByPoints, inside.Flags, [&](vtkIdType point) { isSelected[point] = 1; });
  return isSelected;
}

InsideBlocks Evaluate(vtkDataObjectTree* input, vtkSelection* selection, vtkExtractSelection* given)
{
  const vtkSmartPointer<vtkExtractSelection> extractor = orOwn(given);
  InsideBlocks inside;
  inside.ByPoints = fieldType(selection, extractor) == vtkSelectionNode::POINT;
  const auto copy = vtkSmartPointer<vtkDataObjectTree>::Take(input->NewInstance());
  Leaves::Copy(input, copy);
  const std::vector<Leaves::Leaf> leaves = Leaves::Of(copy);
  for (const Leaves::Leaf& leaf : leaves)
  {
    if (auto* data = vtkDataSet::SafeDownCast(leaf.Data))
    {
      forget(data);
    }
  }
  const vtkSmartPointer<vtkDataObject> output = extracted(copy, selection, extractor);
  std::map<unsigned int, vtkDataSet*> extractedLeaves; // by flat index
  if (auto* parts = Leaves::TreeOf(output))
  {
    for (const Leaves::Leaf& leaf : Leaves::Of(parts))
    {
      extractedLeaves[leaf.FlatIndex] = vtkDataSet::SafeDownCast(leaf.Data);
    }
  }
  const int type = inside.ByPoints ? vtkDataObject::POINT : vtkDataObject::CELL;
  for (const Leaves::Leaf& leaf : leaves)
  {
    std::vector<std::uint8_t>& flags = inside.Flags.emplace_back();
    auto* data = vtkDataSet::SafeDownCast(leaf.Data);
    const auto found = extractedLeaves.find(leaf.FlatIndex);
    if (data && found != extractedLeaves.end() && found->second &&
        found->second->GetAttributesAsFieldData(type)->HasArray(InsideName))
    {
      const vtkIdType count =
        inside.ByPoints ? data->GetNumberOfPoints() : data->GetNumberOfCells();
      flags = insideOf(found->second, inside.ByPoints, count);
    }
  }
  return inside;
}

std::vector<std::uint8_t> Points(
  const Blocks& blocks, vtkSelection* selection, vtkExtractSelection* extractor)
{
  const InsideBlocks inside = Evaluate(blocks.Tree(), selection, extractor);
  const std::vector<Leaves::Leaf> leaves = Leaves::Of(blocks.Tree());
  const MergedBlocks* merged = blocks.Merged();
  std::vector<std::uint8_t> isSelected(merged->Grid->GetNumberOfPoints(), 0);
  for (std::size_t i = 0; i < leaves.size(); ++i)
  {
    const std::vector<morph::Index>& nodes = merged->All[i].Nodes;
    if (!nodes.empty())
    {
      markPoints(vtkDataSet::SafeDownCast(leaves[i].Data), inside.ByPoints, inside.Flags[i],
        [&](vtkIdType point)
        {
          if (nodes[point] >= 0)
          {
            isSelected[nodes[point]] = 1;
          }
        });
    }
  }
  return isSelected;
}

OnGrid Translate(const Blocks& blocks, vtkDataObjectTree* shown, vtkSelection* selection,
  vtkExtractSelection* extractor)
{
  const MergedBlocks* merged = blocks.Merged();
  if (!merged || !merged->Grid)
  {
    throw morph::Error("The mesh is not read yet. Apply the filter once.");
  }
  const std::vector<Leaves::Leaf> leaves = Leaves::Of(shown);
  if (leaves.size() != merged->All.size())
  {
    throw morph::Error("It is of data with other blocks than the mesh. Select points or cells of "
                       "the mesh.");
  }
  const InsideBlocks inside = Evaluate(shown, selection, extractor);
  OnGrid result;
  result.Shown = merged->Grid;
  vtkNew<vtkIdTypeArray> ids;
  for (std::size_t i = 0; i < leaves.size(); ++i)
  {
    auto* data = vtkDataSet::SafeDownCast(leaves[i].Data);
    const MergedBlocks::Block& block = merged->All[i];
    const std::vector<std::uint8_t>& flags = inside.Flags[i];
    for (std::size_t k = 0; !block.Nodes.empty() && k < flags.size(); ++k)
    {
      const vtkIdType id = !flags[k]         ? -1
                           : inside.ByPoints ? block.Nodes[k]
                                             : idOf(static_cast<vtkIdType>(k), block, data,
                                                 merged->Grid, result.Shown);
      if (id >= 0)
      {
        ids->InsertNextValue(id);
      }
    }
  }
  result.Selection =
    selectionOf(ids, inside.ByPoints ? vtkSelectionNode::POINT : vtkSelectionNode::CELL);
  return result;
}
}

vtkSelection* BlockSelection::OfGrid(
  const Blocks& blocks, vtkSelection* selection, vtkExtractSelection* extractor)
{
  const MergedBlocks* merged = blocks.Merged();
  if (!merged || !selection || selection->GetNumberOfNodes() == 0)
  {
    return selection;
  }
  vtkUnstructuredGrid* grid = merged->Grid;
  if (this->Translated && this->Grid == grid && this->GridTime == grid->GetMTime() &&
      this->Given == selection && this->GivenTime == selection->GetMTime() &&
      this->Extractor == extractor)
  {
    return this->Translated;
  }
  const std::vector<std::uint8_t> isSelected = Selection::Points(blocks, selection, extractor);
  vtkNew<vtkIdTypeArray> ids;
  for (std::size_t i = 0; i < isSelected.size(); ++i)
  {
    if (isSelected[i])
    {
      ids->InsertNextValue(static_cast<vtkIdType>(i));
    }
  }
  this->Translated = selectionOf(ids, vtkSelectionNode::POINT);
  this->Grid = grid;
  this->GridTime = grid->GetMTime();
  this->Given = selection;
  this->GivenTime = selection->GetMTime();
  this->Extractor = extractor;
  return this->Translated;
}
}
