// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Blocks/BlockSets.h"

#include "Private/Data/Arrays.h"

#include <vtkDataSet.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <iterator>

namespace morph::filters::BlockSets
{
namespace
{
using morph::Index;

bool isSet(const MergedBlocks::Block& block)
{
  return !block.IsMesh && !block.Nodes.empty();
}

/// The names that the data have already.
vtkSmartPointer<vtkStringArray> knownNames(vtkFieldData* data)
{
  auto names = vtkSmartPointer<vtkStringArray>::New();
  if (auto* given = vtkStringArray::SafeDownCast(data->GetAbstractArray("SurfaceNames")))
  {
    names->DeepCopy(given);
  }
  names->SetName("SurfaceNames");
  return names;
}
}

void Name(const std::vector<Leaves::Leaf>& leaves, MergedBlocks& merged)
{
  Marks marks;
  for (std::size_t i = 0; i < leaves.size(); ++i)
  {
    const std::string& label = leaves[i].Label;
    if (!isSet(merged.All[i]) || label.empty() ||
        merged.Grid->GetPointData()->HasArray(label.c_str()))
    {
      continue;
    }
    std::vector<Index>& nodes = marks[label];
    std::copy_if(merged.All[i].Nodes.begin(), merged.All[i].Nodes.end(), std::back_inserter(nodes),
      [](Index node) { return node >= 0; });
  }
  AddMarks(marks, merged.Grid);
}

void AddMarks(const Marks& marks, vtkUnstructuredGrid* grid)
{
  if (marks.empty())
  {
    return;
  }
  const vtkSmartPointer<vtkStringArray> names = knownNames(grid->GetFieldData());
  for (const auto& [label, nodes] : marks)
  {
    auto array = Arrays::Make<vtkUnsignedCharArray>(label.c_str(), grid->GetNumberOfPoints());
    array->FillValue(0);
    for (const Index node : nodes)
    {
      array->SetValue(static_cast<vtkIdType>(node), 1);
    }
    grid->GetPointData()->AddArray(array);
    if (names->LookupValue(label) < 0)
    {
      names->InsertNextValue(label);
    }
  }
  grid->GetFieldData()->AddArray(names);
}

void FindBehind(const std::vector<Leaves::Leaf>& leaves, MergedBlocks& merged)
{
  vtkNew<vtkIdList> points, nodes, cells;
  bool hasLinks = false;
  for (std::size_t i = 0; i < leaves.size(); ++i)
  {
    MergedBlocks::Block& block = merged.All[i];
    auto* data = isSet(block) ? vtkDataSet::SafeDownCast(leaves[i].Data) : nullptr;
    const vtkIdType count = data ? data->GetNumberOfCells() : 0;
    if (count > 0 && !hasLinks)
    {
      merged.Grid->BuildLinks();
      hasLinks = true;
    }
    for (vtkIdType cell = 0; cell < count; ++cell)
    {
      data->GetCellPoints(cell, points);
      nodes->Reset();
      bool isOnMesh = points->GetNumberOfIds() > 0;
      for (vtkIdType k = 0; k < points->GetNumberOfIds(); ++k)
      {
        const Index node = block.Nodes[static_cast<std::size_t>(points->GetId(k))];
        isOnMesh &= node >= 0;
        nodes->InsertNextId(node);
      }
      std::vector<Index>& behind = block.Behind.emplace_back();
      if (isOnMesh)
      {
        merged.Grid->GetCellNeighbors(-1, nodes, cells);
        behind.assign(cells->begin(), cells->end());
      }
    }
  }
}
}
