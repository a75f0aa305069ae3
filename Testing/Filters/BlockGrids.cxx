// SPDX-License-Identifier: BSD-3-Clause
#include "BlockGrids.h"

#include <vtkCellData.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataObjectTree.h>
#include <vtkDataObjectTreeIterator.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkInformation.h>
#include <vtkInformationStringKey.h>
#include <vtkNew.h>
#include <vtkPartitionedDataSet.h>
#include <vtkPointData.h>
#include <vtkPoints.h>

#include <gtest/gtest.h>

#include <array>
#include <set>

namespace blocks
{
namespace
{
void copyTuples(vtkDataSetAttributes* from, const std::vector<vtkIdType>& ids, const char* idName,
  bool withIds, vtkDataSetAttributes* to)
{
  to->CopyAllOn();
  to->CopyAllocate(from);
  vtkNew<vtkIdTypeArray> global;
  global->SetName(idName);
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    to->CopyData(from, ids[i], static_cast<vtkIdType>(i));
    global->InsertNextValue(10 + 3 * ids[i]);
  }
  if (withIds)
  {
    to->SetGlobalIds(global);
  }
}
}

Pieces cut(vtkUnstructuredGrid* grid, int pieces,
  const std::function<int(const grids::Row&)>& pieceOf, bool withIds)
{
  std::vector<std::vector<vtkIdType>> cells(pieces);
  vtkNew<vtkIdList> corners;
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c)
  {
    grid->GetCellPoints(c, corners);
    grids::Row center(0, 0, 0);
    for (vtkIdType k = 0; k < corners->GetNumberOfIds(); ++k)
    {
      center += Eigen::Map<const grids::Row>(grid->GetPoint(corners->GetId(k)));
    }
    cells[pieceOf(center / static_cast<double>(corners->GetNumberOfIds()))].push_back(c);
  }
  Pieces result;
  for (const std::vector<vtkIdType>& chosen : cells)
  {
    std::set<vtkIdType> nodes;
    for (const vtkIdType c : chosen)
    {
      grid->GetCellPoints(c, corners);
      nodes.insert(corners->GetPointer(0), corners->GetPointer(0) + corners->GetNumberOfIds());
    }
    const std::vector<vtkIdType> order(nodes.begin(), nodes.end());
    auto piece = vtkSmartPointer<vtkUnstructuredGrid>::New();
    vtkNew<vtkPoints> points;
    points->SetDataType(grid->GetPoints()->GetDataType());
    std::map<vtkIdType, vtkIdType> number;
    for (const vtkIdType node : order)
    {
      number[node] = points->InsertNextPoint(grid->GetPoint(node));
    }
    piece->SetPoints(points);
    piece->Allocate(static_cast<vtkIdType>(chosen.size()));
    for (const vtkIdType c : chosen)
    {
      grid->GetCellPoints(c, corners);
      for (vtkIdType k = 0; k < corners->GetNumberOfIds(); ++k)
      {
        corners->SetId(k, number[corners->GetId(k)]);
      }
      piece->InsertNextCell(grid->GetCellType(c), corners);
    }
    copyTuples(grid->GetPointData(), order, "GlobalNodeId", withIds, piece->GetPointData());
    copyTuples(grid->GetCellData(), chosen, "GlobalElementId", withIds, piece->GetCellData());
    result.push_back(piece);
  }
  return result;
}

Pieces quarters(vtkUnstructuredGrid* grid, bool withIds)
{
  return cut(
    grid, 4, [](const grids::Row& x) { return (x[0] < 0 ? 1 : 0) + (x[1] < 0 ? 2 : 0); }, withIds);
}

vtkSmartPointer<vtkUnstructuredGrid> joined(const Pieces& pieces)
{
  auto result = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  points->SetDataType(pieces.front()->GetPoints()->GetDataType());
  vtkNew<vtkIdTypeArray> numbers, cells;
  numbers->SetName("Number");
  cells->SetName("Cell");
  std::map<std::array<double, 3>, vtkIdType> known;
  vtkNew<vtkIdList> corners;
  result->Allocate(8);
  for (const auto& piece : pieces)
  {
    std::vector<vtkIdType> node;
    for (vtkIdType i = 0; i < piece->GetNumberOfPoints(); ++i)
    {
      const double* x = piece->GetPoint(i);
      const auto [place, isNew] =
        known.try_emplace({ x[0], x[1], x[2] }, points->GetNumberOfPoints());
      if (isNew)
      {
        points->InsertNextPoint(piece->GetPoint(i));
        numbers->InsertNextValue(
          static_cast<vtkIdType>(piece->GetPointData()->GetArray("Number")->GetComponent(i, 0)));
      }
      node.push_back(place->second);
    }
    for (vtkIdType c = 0; c < piece->GetNumberOfCells(); ++c)
    {
      piece->GetCellPoints(c, corners);
      for (vtkIdType k = 0; k < corners->GetNumberOfIds(); ++k)
      {
        corners->SetId(k, node[corners->GetId(k)]);
      }
      result->InsertNextCell(piece->GetCellType(c), corners);
      cells->InsertNextValue(
        static_cast<vtkIdType>(piece->GetCellData()->GetArray("Cell")->GetComponent(c, 0)));
    }
  }
  result->SetPoints(points);
  result->GetPointData()->AddArray(numbers);
  result->GetCellData()->AddArray(cells);
  return result;
}

vtkSmartPointer<vtkMultiBlockDataSet> multiBlock(const Pieces& pieces)
{
  auto inner = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  inner->SetBlock(0, pieces[0]);
  inner->SetBlock(1, nullptr);
  inner->GetMetaData(0u)->Set(vtkCompositeDataSet::NAME(), "A");
  if (pieces.size() > 1)
  {
    inner->SetBlock(2, pieces[1]);
    inner->GetMetaData(2u)->Set(vtkCompositeDataSet::NAME(), "B");
  }
  auto root = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  root->SetBlock(0, inner);
  root->GetMetaData(0u)->Set(vtkCompositeDataSet::NAME(), "Solid");
  for (unsigned int i = 2; i < pieces.size(); ++i)
  {
    root->SetBlock(i - 1, pieces[i]);
    root->GetMetaData(i - 1)->Set(
      vtkCompositeDataSet::NAME(), std::string(1, static_cast<char>('A' + i)).c_str());
  }
  return root;
}

vtkSmartPointer<vtkPartitionedDataSetCollection> collection(const Pieces& pieces)
{
  auto result = vtkSmartPointer<vtkPartitionedDataSetCollection>::New();
  unsigned int set = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i)
  {
    vtkNew<vtkPartitionedDataSet> parts;
    parts->SetPartition(0, pieces[i]);
    if (i == 0 && pieces.size() > 1)
    {
      parts->SetPartition(1, pieces[++i]);
    }
    result->SetPartitionedDataSet(set, parts);
    result->GetMetaData(set)->Set(
      vtkCompositeDataSet::NAME(), std::string(1, static_cast<char>('A' + set)).c_str());
    ++set;
  }
  return result;
}

std::vector<vtkSmartPointer<vtkDataObject>> leaves(vtkDataObject* tree)
{
  std::vector<vtkSmartPointer<vtkDataObject>> result;
  auto* data = vtkDataObjectTree::SafeDownCast(tree);
  EXPECT_NE(data, nullptr);
  if (!data)
  {
    return result;
  }
  const auto item = vtkSmartPointer<vtkDataObjectTreeIterator>::Take(data->NewTreeIterator());
  for (item->InitTraversal(); !item->IsDoneWithTraversal(); item->GoToNextItem())
  {
    result.emplace_back(item->GetCurrentDataObject());
  }
  return result;
}

vtkUnstructuredGrid* grid(vtkDataObject* tree, std::size_t leaf)
{
  const auto all = leaves(tree);
  return leaf < all.size() ? vtkUnstructuredGrid::SafeDownCast(all[leaf]) : nullptr;
}

std::map<vtkIdType, grids::Row> pointsByNumber(vtkDataObject* tree)
{
  std::map<vtkIdType, grids::Row> result;
  for (const auto& leaf : leaves(tree))
  {
    auto* set = vtkPointSet::SafeDownCast(leaf);
    vtkDataArray* numbers = set ? set->GetPointData()->GetArray("Number") : nullptr;
    for (vtkIdType i = 0; numbers && i < set->GetNumberOfPoints(); ++i)
    {
      const grids::Row x = Eigen::Map<const grids::Row>(set->GetPoint(i));
      const auto place =
        result.emplace(static_cast<vtkIdType>(numbers->GetComponent(i, 0)), x).first;
      EXPECT_EQ(place->second, x) << "two points of node " << place->first;
    }
  }
  return result;
}

std::map<vtkIdType, double> cellsByNumber(vtkDataObject* tree, const char* name)
{
  std::map<vtkIdType, double> result;
  for (const auto& leaf : leaves(tree))
  {
    auto* data = vtkDataSet::SafeDownCast(leaf);
    vtkDataArray* numbers = data ? data->GetCellData()->GetArray("Cell") : nullptr;
    vtkDataArray* values = data ? data->GetCellData()->GetArray(name) : nullptr;
    for (vtkIdType c = 0; numbers && values && c < data->GetNumberOfCells(); ++c)
    {
      result[static_cast<vtkIdType>(numbers->GetComponent(c, 0))] = values->GetComponent(c, 0);
    }
  }
  return result;
}
}
