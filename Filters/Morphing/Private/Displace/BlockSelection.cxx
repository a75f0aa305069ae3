// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Displace/BlockSelection.h"

#include "Private/Blocks/Blocks.h"
#include "Private/Displace/Selection.h"

#include <vtkExtractSelection.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkSelection.h>
#include <vtkSelectionNode.h>
#include <vtkUnstructuredGrid.h>

namespace morph::filters
{
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
  vtkNew<vtkSelectionNode> node;
  node->SetContentType(vtkSelectionNode::INDICES);
  node->SetFieldType(vtkSelectionNode::POINT);
  node->SetSelectionList(ids);
  this->Translated = vtkSmartPointer<vtkSelection>::New();
  this->Translated->AddNode(node);
  this->Grid = grid;
  this->GridTime = grid->GetMTime();
  this->Given = selection;
  this->GivenTime = selection->GetMTime();
  this->Extractor = extractor;
  return this->Translated;
}
}
