// SPDX-License-Identifier: BSD-3-Clause
#include "Private/RankBlocks/RankSets.h"

#include "Private/Blocks/BlockCells.h"
#include "Private/Blocks/BlockSets.h"
#include "Private/Blocks/BlockWarnings.h"
#include "Private/Data/DataCheck.h"
#include "Private/RankBlocks/GlobalRanks.h"

#include <vtkDataArray.h>
#include <vtkDataSet.h>
#include <vtkMath.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <map>
#include <unordered_map>
#include <utility>

namespace morph::filters
{
namespace
{
using morph::Index;
using morph::distributed::SharedPlaces;

/// The points of a block that is no part of the mesh; null for other blocks, and for those without
/// points.
vtkPointSet* setOf(const Leaves::Leaf& leaf, const MergedBlocks::Block& block)
{
  auto* set = vtkPointSet::SafeDownCast(leaf.Data);
  return !block.IsMesh && set && set->GetNumberOfPoints() > 0 ? set : nullptr;
}

/// Whether it is no data set, or one without points of its own.
bool cannotFollow(const Leaves::Leaf& leaf, const MergedBlocks::Block& block)
{
  auto* data = vtkDataSet::SafeDownCast(leaf.Data);
  return !block.IsMesh && !vtkPointSet::SafeDownCast(leaf.Data) &&
         (!data || data->GetNumberOfPoints() > 0);
}

/// Appends points that are in no cell. Their values are NaN, or 0.
void addPoints(const std::vector<SharedPlaces::Position>& added, vtkUnstructuredGrid* grid)
{
  vtkNew<vtkPoints> points;
  points->SetDataType(grid->GetPoints() ? grid->GetPoints()->GetDataType() : VTK_DOUBLE);
  const vtkIdType before = grid->GetNumberOfPoints();
  if (before > 0)
  {
    points->DeepCopy(grid->GetPoints());
  }
  for (const SharedPlaces::Position& x : added)
  {
    points->InsertNextPoint(x.data());
  }
  grid->SetPoints(points);
  vtkPointData* data = grid->GetPointData();
  for (int i = 0; before > 0 && i < data->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* array = data->GetAbstractArray(i);
    auto* numbers = vtkDataArray::SafeDownCast(array);
    const bool isReal =
      numbers && (numbers->GetDataType() == VTK_DOUBLE || numbers->GetDataType() == VTK_FLOAT);
    for (std::size_t k = 0; k < added.size(); ++k)
    {
      const vtkIdType tuple = array->InsertNextTuple(0, array);
      for (int j = 0; numbers && j < numbers->GetNumberOfComponents(); ++j)
      {
        numbers->SetComponent(tuple, j, isReal ? vtkMath::Nan() : 0);
      }
    }
  }
}
}

std::vector<Index> RankSets::Follow(
  bool byIds, MergedBlocks& merged, std::vector<std::string>& warnings) const
{
  std::vector<SharedPlaces::Place> places;
  this->Ranks.together(
    [&]
    {
      for (std::size_t i = 0; i < this->Mine.size(); ++i)
      {
        vtkPointSet* set = setOf(this->Mine[i], merged.All[i]);
        if (!set)
        {
          continue;
        }
        DataCheck::Require(set, merged.All[i].Name.c_str());
        const std::vector<Index> ids =
          byIds ? BlockCells::GlobalIds(set->GetPointData(), set->GetNumberOfPoints())
                : std::vector<Index>();
        for (vtkIdType p = 0; p < set->GetNumberOfPoints(); ++p)
        {
          SharedPlaces::Place& place = places.emplace_back();
          set->GetPoint(p, place.x.data());
          place.id = ids.empty() ? -1 : ids[p];
        }
      }
    });
  return this->Warn(this->FindNodes(places, merged), merged, warnings);
}

/// `places`: of the points of all sets of this process, one after another.
RankSets::Counts RankSets::FindNodes(
  const std::vector<SharedPlaces::Place>& places, MergedBlocks& merged) const
{
  const std::vector<std::int64_t> found = this->Places.find(places);
  std::unordered_map<Index, Index> nodeOf;
  for (std::size_t n = 0; n < merged.NodeIds.size(); ++n)
  {
    nodeOf.emplace(merged.NodeIds[n], static_cast<Index>(n));
  }
  std::vector<SharedPlaces::Position> added;
  const std::vector<Index> none(this->Blocks, 0);
  Counts counts = { none, none, none };
  std::size_t next = 0;
  for (std::size_t i = 0; i < this->Mine.size(); ++i)
  {
    MergedBlocks::Block& block = merged.All[i];
    const Index number = this->Numbers[i];
    vtkPointSet* set = setOf(this->Mine[i], block);
    if (!set)
    {
      counts.Missing[number] += cannotFollow(this->Mine[i], block);
      continue;
    }
    Index missing = 0;
    for (vtkIdType p = 0; p < set->GetNumberOfPoints(); ++p, ++next)
    {
      if (found[next] < 0)
      {
        block.Nodes.push_back(-1);
        ++missing;
        continue;
      }
      const auto [known, isNew] =
        nodeOf.try_emplace(found[next], static_cast<Index>(merged.NodeIds.size()));
      if (isNew)
      {
        merged.NodeIds.push_back(found[next]);
        added.push_back(places[next].x);
      }
      block.Nodes.push_back(known->second);
    }
    counts.NoPart[number] += !block.MayHang;
    counts.Missing[number] += missing;
    counts.Found[number] += set->GetNumberOfPoints() - missing;
    if (missing == set->GetNumberOfPoints())
    {
      block.Nodes.clear();
    }
  }
  if (!added.empty())
  {
    addPoints(added, merged.Grid);
  }
  return counts;
}

std::vector<Index> RankSets::Warn(
  Counts counts, const MergedBlocks& merged, std::vector<std::string>& warnings) const
{
  for (std::vector<Index>* numbers : { &counts.Found, &counts.Missing, &counts.NoPart })
  {
    this->Ranks.sum(numbers->data(), numbers->size());
  }
  std::vector<std::string> mine;
  for (std::size_t i = 0; i < this->Mine.size(); ++i)
  {
    mine.push_back(std::to_string(this->Numbers[i]) + " " + merged.All[i].Name);
  }
  std::map<Index, std::string> names; // partitions have several: one of them
  for (const std::string& text : GatherTexts(this->Ranks, mine))
  {
    names.try_emplace(std::stoll(text), text.substr(text.find(' ') + 1));
  }
  std::vector<std::string> unchanged;
  std::vector<Index> hanging;
  for (const auto& [number, name] : names)
  {
    const Index missing = counts.Missing[number], points = missing + counts.Found[number];
    if (missing > 0 && missing == points)
    {
      unchanged.push_back(name);
    }
    else if (missing > 0)
    {
      warnings.push_back(BlockWarnings::Missing(name, missing, points));
      if (counts.NoPart[number] == 0)
      {
        hanging.push_back(number);
      }
    }
  }
  if (const std::string text = BlockWarnings::Unchanged(unchanged); !text.empty())
  {
    warnings.push_back(text);
  }
  return hanging;
}

void RankSets::Name(MergedBlocks& merged) const
{
  struct Mark
  {
    std::int64_t id, name;
  };
  std::vector<std::string> mine;
  for (std::size_t i = 0; i < this->Mine.size(); ++i)
  {
    if (!merged.All[i].IsMesh && !merged.All[i].Nodes.empty() && !this->Mine[i].Label.empty())
    {
      mine.push_back(this->Mine[i].Label);
    }
  }
  const std::vector<std::string> labels = GatherTexts(this->Ranks, mine);
  std::vector<Index> isArray(labels.size(), 0);
  for (std::size_t k = 0; k < labels.size(); ++k)
  {
    isArray[k] = merged.Grid->GetPointData()->HasArray(labels[k].c_str());
  }
  this->Ranks.sum(isArray.data(), isArray.size());
  std::vector<Mark> marks;
  std::vector<std::pair<Index, Index>> marked; // nodes and labels
  for (std::size_t i = 0; i < this->Mine.size(); ++i)
  {
    const std::string& label = this->Mine[i].Label;
    const auto place = std::lower_bound(labels.begin(), labels.end(), label);
    if (merged.All[i].IsMesh || place == labels.end() || *place != label)
    {
      continue;
    }
    const Index name = place - labels.begin();
    for (const Index node : merged.All[i].Nodes)
    {
      if (node >= 0)
      {
        marks.push_back({ merged.NodeIds[node], name });
        marked.emplace_back(node, name); // the others do not know it where it was added
      }
    }
  }
  std::multimap<Index, Index> nodesOf;
  for (std::size_t n = 0; n < merged.NodeIds.size(); ++n)
  {
    nodesOf.emplace(merged.NodeIds[n], static_cast<Index>(n));
  }
  for (const Mark& mark : this->Places.directory().route(marks))
  {
    const auto [first, last] = nodesOf.equal_range(mark.id);
    std::for_each(
      first, last, [&](const auto& node) { marked.emplace_back(node.second, mark.name); });
  }
  BlockSets::Marks all;
  for (std::size_t k = 0; k < labels.size(); ++k)
  {
    if (isArray[k] == 0)
    {
      all[labels[k]];
    }
  }
  for (const auto& [node, name] : marked)
  {
    if (isArray[name] == 0)
    {
      all[labels[name]].push_back(node);
    }
  }
  BlockSets::AddMarks(all, merged.Grid);
}
}
