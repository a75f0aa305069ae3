// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Displace/BlockPick.h"

#include "Private/Blocks/Blocks.h"
#include "Private/Blocks/Leaves.h"
#include "Private/Displace/Selection.h"
#include "Support/Error.h"

#include <vtkCell.h>
#include <vtkCellType.h>
#include <vtkDataObjectTree.h>
#include <vtkDataSet.h>
#include <vtkExtractSelection.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkSelection.h>
#include <vtkSelectionNode.h>
#include <vtkUnstructuredGrid.h>

#include <string>

namespace morph::filters::BlockPick
{
namespace
{
using morph::Index;
using Block = MergedBlocks::Block;

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
vtkIdType idOf(vtkIdType cell, const Block& block, vtkDataSet* data, vtkUnstructuredGrid* grid,
  vtkSmartPointer<vtkUnstructuredGrid>& shown)
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
    const Index node = block.Nodes[static_cast<std::size_t>(points->GetId(k))];
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
  const Selection::InsideBlocks inside = Selection::Evaluate(shown, selection, extractor);
  OnGrid result;
  result.Shown = merged->Grid;
  vtkNew<vtkIdTypeArray> ids;
  for (std::size_t i = 0; i < leaves.size(); ++i)
  {
    auto* data = vtkDataSet::SafeDownCast(leaves[i].Data);
    const Block& block = merged->All[i];
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
  vtkNew<vtkSelectionNode> node;
  node->SetContentType(vtkSelectionNode::INDICES);
  node->SetFieldType(inside.ByPoints ? vtkSelectionNode::POINT : vtkSelectionNode::CELL);
  node->SetSelectionList(ids);
  result.Selection = vtkSmartPointer<vtkSelection>::New();
  result.Selection->AddNode(node);
  return result;
}
}
