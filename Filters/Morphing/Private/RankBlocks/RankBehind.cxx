// SPDX-License-Identifier: BSD-3-Clause
#include "Private/RankBlocks/RankBehind.h"

#include "Private/RankBlocks/SharedCells.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSet.h>
#include <vtkIdList.h>
#include <vtkMath.h>
#include <vtkNew.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace morph::filters
{
namespace
{
using morph::Index;

/// The ids of the nodes of a set's cell; empty where a point is on no node.
std::vector<std::int64_t> idsOf(
  vtkIdList* points, const MergedBlocks::Block& block, const std::vector<Index>& nodeIds)
{
  std::vector<std::int64_t> ids;
  for (const vtkIdType point : *points)
  {
    const Index node = block.Nodes[static_cast<std::size_t>(point)];
    if (node < 0)
    {
      return {};
    }
    ids.push_back(nodeIds[node]);
  }
  return ids;
}
}

RankBehind::RankBehind(const morph::distributed::Ranks& ranks,
  const std::vector<Leaves::Leaf>& mine, const morph::distributed::SharedPlaces& places,
  const MergedBlocks& merged)
  : Ranks(ranks)
  , Cells(mine.size(), 0)
  , Questions(ranks.count())
  , Answers(ranks.count())
{
  std::vector<std::pair<std::size_t, vtkIdType>> asked;
  std::vector<std::vector<std::int64_t>> nodes;
  std::vector<std::int64_t> first;
  vtkNew<vtkIdList> points;
  for (std::size_t i = 0; i < mine.size(); ++i)
  {
    const MergedBlocks::Block& block = merged.All[i];
    auto* data = vtkDataSet::SafeDownCast(mine[i].Data);
    this->Cells[i] = block.IsMesh || block.Nodes.empty() || !data ? 0 : data->GetNumberOfCells();
    for (vtkIdType c = 0; c < this->Cells[i]; ++c)
    {
      data->GetCellPoints(c, points);
      std::vector<std::int64_t> ids = idsOf(points, block, merged.NodeIds);
      if (!ids.empty())
      {
        asked.emplace_back(i, c);
        first.push_back(ids.front());
        nodes.push_back(std::move(ids));
      }
    }
  }
  const std::vector<std::vector<int>> holders = places.directory().holders(first);
  std::vector<std::vector<std::vector<std::int64_t>>> to(ranks.count());
  for (std::size_t k = 0; k < asked.size(); ++k)
  {
    for (const int rank : holders[k])
    {
      this->Questions[rank].push_back(asked[k]);
      to[rank].push_back(nodes[k]);
    }
  }

  std::unordered_map<Index, vtkIdType> nodeOf;
  const auto from = ranks.exchange(to);
  if (std::any_of(from.begin(), from.end(), [](const auto& part) { return !part.empty(); }))
  {
    for (std::size_t n = 0; n < merged.NodeIds.size(); ++n)
    {
      nodeOf.emplace(merged.NodeIds[n], static_cast<vtkIdType>(n));
    }
    merged.Grid->BuildLinks();
  }
  const std::vector<std::uint8_t> isGhost = SharedCells::Ghosts(merged.Grid);
  vtkNew<vtkIdList> corners, cells;
  for (int r = 0; r < ranks.count(); ++r)
  {
    for (const std::vector<std::int64_t>& ids : from[r])
    {
      corners->Reset();
      bool isHere = true;
      for (const std::int64_t id : ids)
      {
        const auto node = nodeOf.find(id);
        isHere = isHere && node != nodeOf.end();
        if (isHere)
        {
          corners->InsertNextId(node->second);
        }
      }
      std::vector<vtkIdType>& behind = this->Answers[r].emplace_back();
      if (isHere)
      {
        merged.Grid->GetCellNeighbors(-1, corners, cells);
        std::copy_if(cells->begin(), cells->end(), std::back_inserter(behind),
          [&](vtkIdType c) { return isGhost[c] == 0; });
      }
    }
  }
}

std::vector<std::vector<double>> RankBehind::Worst(vtkDataArray* values) const
{
  std::vector<std::vector<double>> result(this->Cells.size());
  if (this->Ranks.sum(Index(values != nullptr)) == 0)
  {
    return result;
  }
  std::vector<std::vector<double>> to(this->Answers.size());
  for (std::size_t r = 0; r < to.size(); ++r)
  {
    for (const std::vector<vtkIdType>& cells : this->Answers[r])
    {
      double worst = vtkMath::Nan();
      for (const vtkIdType cell : cells)
      {
        worst = values ? std::fmin(worst, values->GetComponent(cell, 0)) : worst; // a NaN loses
      }
      to[r].push_back(worst);
    }
  }
  const auto from = this->Ranks.exchange(to);
  for (std::size_t i = 0; i < result.size(); ++i)
  {
    result[i].assign(static_cast<std::size_t>(this->Cells[i]), vtkMath::Nan());
  }
  for (std::size_t r = 0; r < from.size(); ++r)
  {
    for (std::size_t k = 0; k < from[r].size(); ++k)
    {
      const auto& [leaf, cell] = this->Questions[r][k];
      double& worst = result[leaf][static_cast<std::size_t>(cell)];
      worst = std::fmin(worst, from[r][k]);
    }
  }
  return result;
}
}
