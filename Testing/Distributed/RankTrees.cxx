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

vtkSmartPointer<vtkDataObjectTree> part(
  const morph::distributed::Ranks& ranks, vtkDataObjectTree* whole, unsigned seed, int ofSets)
{
  const auto result = vtkSmartPointer<vtkDataObjectTree>::Take(whole->NewInstance());
  result->ShallowCopy(whole);
  std::mt19937 random(seed);
  const auto item = vtkSmartPointer<vtkDataObjectTreeIterator>::Take(whole->NewTreeIterator());
  for (item->InitTraversal(); !item->IsDoneWithTraversal(); item->GoToNextItem())
  {
    auto* data = vtkDataSet::SafeDownCast(item->GetCurrentDataObject());
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
    result->SetDataSetFrom(item, cellsOf(data, mine));
  }
  return result;
}

vtkSmartPointer<vtkDataObjectTree> wholeLeaves(
  const morph::distributed::Ranks& ranks, vtkDataObjectTree* whole)
{
  const auto result = vtkSmartPointer<vtkDataObjectTree>::Take(whole->NewInstance());
  result->ShallowCopy(whole);
  const auto item = vtkSmartPointer<vtkDataObjectTreeIterator>::Take(whole->NewTreeIterator());
  int leaf = 0;
  for (item->InitTraversal(); !item->IsDoneWithTraversal(); item->GoToNextItem())
  {
    if (leaf++ % ranks.count() != ranks.rank())
    {
      result->SetDataSetFrom(item, nullptr);
    }
  }
  return result;
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
