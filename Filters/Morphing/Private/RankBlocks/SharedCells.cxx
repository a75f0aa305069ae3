// SPDX-License-Identifier: BSD-3-Clause
#include "Private/RankBlocks/SharedCells.h"

#include "Private/Blocks/BlockCells.h"

#include <vtkCellData.h>
#include <vtkDataSetAttributes.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <map>
#include <utility>

namespace morph::filters::SharedCells
{
namespace
{
using morph::Index;
using morph::distributed::Ranks;

bool isGhost(vtkUnstructuredGrid* grid, vtkIdType cell)
{
  vtkUnsignedCharArray* ghosts = grid->GetCellGhostArray();
  return ghosts && (ghosts->GetValue(cell) & vtkDataSetAttributes::DUPLICATECELL);
}

int rankOf(std::int64_t id, const Ranks& ranks)
{
  return static_cast<int>(id % ranks.count());
}

void makeGhosts(const std::vector<Index>& cells, vtkUnstructuredGrid* grid)
{
  if (cells.empty())
  {
    return;
  }
  vtkUnsignedCharArray* ghosts = grid->GetCellGhostArray();
  if (!ghosts)
  {
    ghosts = grid->AllocateCellGhostArray();
  }
  for (const Index cell : cells)
  {
    const auto c = static_cast<vtkIdType>(cell);
    ghosts->SetValue(c, ghosts->GetValue(c) | vtkDataSetAttributes::DUPLICATECELL);
  }
}

/// Whether no two of all processes' ids are equal.
bool areDifferent(const Ranks& ranks, const std::vector<Index>& ids)
{
  std::vector<std::vector<Index>> to(ranks.count());
  for (const Index id : ids)
  {
    to[rankOf(id, ranks)].push_back(id);
  }
  std::vector<Index> met = morph::distributed::joined(ranks.exchange(to));
  std::sort(met.begin(), met.end());
  const bool isTwice = std::adjacent_find(met.begin(), met.end()) != met.end();
  return ranks.sum(Index(isTwice)) == 0;
}
}

void MarkGhosts(const Ranks& ranks, const std::vector<std::int64_t>& ids,
  const std::vector<std::uint8_t>& isShared, vtkUnstructuredGrid* grid)
{
  // Its number, type and nodes' ids in ascending order, after their count.
  std::vector<std::vector<std::int64_t>> to(ranks.count());
  vtkNew<vtkIdList> corners;
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c)
  {
    grid->GetCellPoints(c, corners);
    const bool mayBeElsewhere =
      corners->GetNumberOfIds() > 0 && !isGhost(grid, c) &&
      std::all_of(corners->begin(), corners->end(), [&](vtkIdType n) { return isShared[n] != 0; });
    if (!mayBeElsewhere)
    {
      continue;
    }
    std::vector<std::int64_t> nodes;
    for (const vtkIdType n : *corners)
    {
      nodes.push_back(ids[n]);
    }
    std::sort(nodes.begin(), nodes.end());
    std::vector<std::int64_t>& stream = to[rankOf(nodes.front(), ranks)];
    stream.insert(
      stream.end(), { static_cast<std::int64_t>(nodes.size()), c, grid->GetCellType(c) });
    stream.insert(stream.end(), nodes.begin(), nodes.end());
  }
  std::map<std::vector<std::int64_t>, int> keeper;
  std::vector<std::vector<Index>> back(ranks.count());
  const auto from = ranks.exchange(to);
  for (int r = 0; r < ranks.count(); ++r)
  {
    for (auto at = from[r].begin(); at != from[r].end();)
    {
      const std::int64_t count = at[0], cell = at[1];
      const auto end = at + 3 + count;
      const int kept = keeper.try_emplace(std::vector<std::int64_t>(at + 2, end), r).first->second;
      if (kept != r)
      {
        back[r].push_back(cell);
      }
      at = end;
    }
  }
  makeGhosts(morph::distributed::joined(ranks.exchange(back)), grid);
}

std::vector<Index> Ids(const Ranks& ranks, vtkUnstructuredGrid* grid)
{
  const vtkIdType count = grid->GetNumberOfCells();
  std::vector<Index> ids = BlockCells::GlobalIds(grid->GetCellData(), count), own;
  for (vtkIdType c = 0; c < count; ++c)
  {
    if (!isGhost(grid, c))
    {
      own.push_back(ids.empty() ? -1 : ids[c]);
    }
  }
  const bool isWithout = count > 0 && ids.empty();
  if (ranks.sum(Index(isWithout)) == 0 && areDifferent(ranks, own))
  {
    return ids;
  }
  Index next = ranks.sumBefore(static_cast<Index>(own.size()));
  ids.assign(count, -1);
  for (vtkIdType c = 0; c < count; ++c)
  {
    ids[c] = isGhost(grid, c) ? -1 : next++;
  }
  return ids;
}
}
