// SPDX-License-Identifier: BSD-3-Clause
#include "RankTrees.h"

#include "BlockGrids.h"

#include <vtkCellData.h>
#include <vtkDataObjectTreeIterator.h>
#include <vtkDataSet.h>
#include <vtkExtractCells.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <random>

namespace rank_trees
{
namespace
{
/// The points of these cells, and their arrays, as polygons.
vtkSmartPointer<vtkPolyData> polygonsOf(vtkUnstructuredGrid* grid)
{
  auto result = vtkSmartPointer<vtkPolyData>::New();
  result->SetPoints(grid->GetPoints());
  result->SetPolys(grid->GetCells());
  result->GetPointData()->ShallowCopy(grid->GetPointData());
  result->GetCellData()->ShallowCopy(grid->GetCellData());
  return result;
}

}

vtkSmartPointer<vtkDataObject> cellsOf(vtkDataSet* data, vtkIdList* ids)
{
  if (ids->GetNumberOfIds() == 0)
  {
    return nullptr;
  }
  vtkNew<vtkExtractCells> extract;
  extract->SetInputData(data);
  extract->SetCellList(ids);
  extract->Update();
  for (vtkDataSetAttributes* attributes :
    { static_cast<vtkDataSetAttributes*>(extract->GetOutput()->GetPointData()),
      static_cast<vtkDataSetAttributes*>(extract->GetOutput()->GetCellData()) })
  {
    attributes->RemoveArray("vtkOriginalCellIds");
  }
  const auto copy = vtkSmartPointer<vtkUnstructuredGrid>::New();
  copy->ShallowCopy(extract->GetOutput());
  if (vtkPolyData::SafeDownCast(data))
  {
    return polygonsOf(copy);
  }
  return copy;
}

vtkSmartPointer<vtkDataObjectTree> withLeaves(vtkDataObjectTree* whole,
  const std::function<vtkSmartPointer<vtkDataObject>(vtkDataObject*)>& leafOf)
{
  const auto result = vtkSmartPointer<vtkDataObjectTree>::Take(whole->NewInstance());
  result->ShallowCopy(whole);
  const auto item = vtkSmartPointer<vtkDataObjectTreeIterator>::Take(whole->NewTreeIterator());
  for (item->InitTraversal(); !item->IsDoneWithTraversal(); item->GoToNextItem())
  {
    result->SetDataSetFrom(item, leafOf(item->GetCurrentDataObject()));
  }
  return result;
}

vtkSmartPointer<vtkDataObjectTree> part(
  const morph::distributed::Ranks& ranks, vtkDataObjectTree* whole, unsigned seed, int ofSets)
{
  std::mt19937 random(seed);
  return withLeaves(whole,
    [&](vtkDataObject* leaf)
    {
      auto* data = vtkDataSet::SafeDownCast(leaf);
      const bool isSet = vtkPolyData::SafeDownCast(data);
      std::uniform_int_distribution<int> rank(0, ranks.count() - 1);
      vtkNew<vtkIdList> mine;
      for (vtkIdType c = 0; c < data->GetNumberOfCells(); ++c)
      {
        const int owner = isSet && ofSets >= 0 ? ofSets : rank(random);
        if (owner == ranks.rank())
        {
          mine->InsertNextId(c);
        }
      }
      return cellsOf(data, mine);
    });
}

vtkSmartPointer<vtkDataObjectTree> wholeLeaves(
  const morph::distributed::Ranks& ranks, vtkDataObjectTree* whole)
{
  int number = 0;
  return withLeaves(whole,
    [&](vtkDataObject* leaf) -> vtkSmartPointer<vtkDataObject>
    { return number++ % ranks.count() == ranks.rank() ? leaf : nullptr; });
}

double distance(const morph::distributed::Ranks& ranks, vtkDataObject* mine,
  const std::map<vtkIdType, grids::Row>& whole)
{
  double most = 0;
  for (const auto& [number, x] : blocks::pointsByNumber(mine))
  {
    most = std::max(most, (x - whole.at(number)).norm());
  }
  return ranks.maximum(most);
}
}
