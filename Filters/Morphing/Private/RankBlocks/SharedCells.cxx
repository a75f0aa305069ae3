// SPDX-License-Identifier: BSD-3-Clause
#include "Private/RankBlocks/SharedCells.h"

#include "Distributed/Piece.h"
#include "Private/Blocks/BlockCells.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

namespace morph::filters::SharedCells
{
namespace
{
using morph::Index;
using morph::distributed::Ranks;

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

std::vector<std::uint8_t> Ghosts(vtkUnstructuredGrid* grid)
{
  std::vector<std::uint8_t> isGhost(grid->GetNumberOfCells(), 0);
  if (vtkUnsignedCharArray* types = grid->GetCellGhostArray())
  {
    std::transform(types->Begin(), types->End(), isGhost.begin(),
      [](unsigned char type) { return type & vtkDataSetAttributes::DUPLICATECELL; });
  }
  return isGhost;
}

std::vector<std::int64_t> Numbers(vtkDataArray* array)
{
  std::vector<std::int64_t> values;
  for (vtkIdType i = 0; array && i < array->GetNumberOfTuples(); ++i)
  {
    values.push_back(static_cast<std::int64_t>(array->GetComponent(i, 0)));
  }
  return values;
}

void MarkGhosts(const Ranks& ranks, const std::vector<std::int64_t>& ids,
  const std::vector<std::uint8_t>& isShared, vtkUnstructuredGrid* grid)
{
  using Key = std::vector<std::int64_t>; // the nodes' ids in ascending order, and its type
  const std::vector<std::uint8_t> isGhost = Ghosts(grid);
  std::vector<Index> cells;
  std::vector<Key> keys;
  vtkNew<vtkIdList> corners;
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c)
  {
    grid->GetCellPoints(c, corners);
    const bool mayBeElsewhere =
      corners->GetNumberOfIds() > 0 && isGhost[c] == 0 &&
      std::all_of(corners->begin(), corners->end(), [&](vtkIdType n) { return isShared[n] != 0; });
    if (mayBeElsewhere)
    {
      cells.push_back(c);
      Key& key = keys.emplace_back();
      std::transform(corners->begin(), corners->end(), std::back_inserter(key),
        [&](vtkIdType n) { return ids[n]; });
      std::sort(key.begin(), key.end());
      key.push_back(grid->GetCellType(c));
    }
  }
  const std::vector<int> keepers = ranks.ask<int>(
    keys, [&](const Key& key) { return rankOf(key.front(), ranks); },
    [](const std::vector<std::vector<Key>>& asked)
    {
      std::map<Key, int> keeper;
      std::vector<std::vector<int>> answers(asked.size());
      for (std::size_t r = 0; r < asked.size(); ++r)
      {
        for (const Key& key : asked[r])
        {
          answers[r].push_back(keeper.try_emplace(key, static_cast<int>(r)).first->second);
        }
      }
      return answers;
    });
  std::vector<Index> others;
  for (std::size_t i = 0; i < cells.size(); ++i)
  {
    if (keepers[i] != ranks.rank())
    {
      others.push_back(cells[i]);
    }
  }
  makeGhosts(others, grid);
}

std::vector<Index> Ids(const Ranks& ranks, vtkUnstructuredGrid* grid)
{
  const vtkIdType count = grid->GetNumberOfCells();
  const std::vector<std::uint8_t> isGhost = Ghosts(grid);
  std::vector<Index> ids = BlockCells::GlobalIds(grid->GetCellData(), count), own;
  for (vtkIdType c = 0; c < count; ++c)
  {
    if (isGhost[c] == 0)
    {
      own.push_back(ids.empty() ? -1 : ids[c]);
    }
  }
  const bool isWithout = count > 0 && ids.empty();
  if (ranks.sum(Index(isWithout)) == 0 && areDifferent(ranks, own))
  {
    return ids;
  }
  return morph::distributed::newCellIds(ranks, isGhost);
}
}
