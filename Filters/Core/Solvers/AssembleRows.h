// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Solvers/ColumnMap.h"
#include "Solvers/CsrMatrix.h"
#include "Solvers/CsrRows.h"
#include "Solvers/RowChunks.h"
#include "Support/HugePages.h"
#include "Support/Monitor.h"
#include "Support/Types.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

namespace morph
{
/// Makes the rows of one chunk. `local`: the columns in a row.
template <typename Scalar, typename MakeRow>
void makeChunk(int first, int last, MakeRow& makeRow, ColumnMap& local, RowsInWork<Scalar>& rows)
{
  rows.clear();
  for (int i = first; i < last; ++i)
  {
    const std::size_t start = rows.column.size();
    local.clear();
    makeRow(i,
      [&](int column, Scalar value)
      {
        const std::size_t at = start + local.localIndex(column);
        if (at < rows.column.size())
        {
          rows.value[at] += value;
          return;
        }
        rows.column.push_back(column);
        rows.value.push_back(value);
      });
    rows.size.push_back(static_cast<int>(rows.column.size() - start));
  }
}

/// Assembles a matrix from its rows in chunks of a fixed size, so it does not depend on threads.
/// makeRow(i, add) calls add(column, value) in any order, also repeatedly for a column. Columns
/// have the order of their first call. makeRow = makeRows() is made once per thread's range.
/// `columns`: of the matrix. Cost: no memory beside the chunks' rows, 1 MiB a range of threads, and
/// the rest of the last page of each arena.
template <typename Scalar, typename MakeRows>
CsrRows<Scalar> assembleRows(int rows, int columns, Monitor& monitor, const MakeRows& makeRows)
{
  const Index chunks = chunksOf(rows);
  std::vector<StoredRows<Scalar>> parts(chunks);
  monitor.parallelFor(chunks, 1,
    [&](Index firstChunk, Index lastChunk)
    {
      std::shared_ptr<PageArena> arena;
      RowsInWork<Scalar> scratch; // keeps its capacity between chunks
      auto makeRow = makeRows();
      ColumnMap local(columns);
      for (Index c = firstChunk; c < lastChunk; ++c)
      {
        if ((c - firstChunk) % ChunksOfArena == 0)
        {
          arena = std::make_shared<PageArena>();
        }
        const Index last = std::min<Index>(rows, (c + 1) * ChunkRows);
        makeChunk(static_cast<int>(c * ChunkRows), static_cast<int>(last), makeRow, local, scratch);
        parts[c] = { scratch, arena };
      }
    });

  CsrRows<Scalar> result;
  result.rows = rows;
  result.ownStart.assign(rows + 1, 0);
  std::size_t entries = 0;
  for (Index c = 0; c < chunks; ++c)
  {
    entries += parts[c].entries();
    requireEntries(static_cast<Index>(entries));
    parts[c].setEnds(result.ownStart.data() + c * ChunkRows);
  }
  resizeUndefined(result.ownColumn, static_cast<Index>(entries));
  resizeUndefined(result.ownValue, static_cast<Index>(entries));
  monitor.parallelFor(chunks, 1,
    [&](Index first, Index last)
    {
      for (Index c = first; c < last; ++c)
      {
        const int at = result.ownStart[c * ChunkRows];
        parts[c].copyAndRelease(result.ownColumn.data() + at, result.ownValue.data() + at);
      }
    });
  result.adopt();
  return result;
}
}
