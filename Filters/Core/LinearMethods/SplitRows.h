// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Solvers/ChunkedMatrix.h"
#include "Solvers/RowChunks.h"
#include "Support/Monitor.h"

#include <algorithm>
#include <memory>
#include <vector>

namespace morph
{
/// Rows of [A_I A_B] in two parts during assembly. Any thread makes chunks of ChunkRows rows, which
/// are then joined. So no thread needs buffers of the matrix's size.
struct SplitRows
{
  using Part = RowsInWork<double>; ///< columns ascend in each row
  Part interior, coupling;

  void clear()
  {
    this->interior.clear();
    this->coupling.clear();
  }
};

/// Both parts, in chunks.
struct SplitChunks
{
  /// Both have `rows` rows; the interior has as many columns.
  SplitChunks(Index rows, Index couplingColumns)
    : interior{ rows, rows, {} }
    , coupling{ rows, couplingColumns, {} }
  {
  }

  ChunkedMatrix interior, coupling;
};

/// Appends the chunks of the rows in [firstRow, lastRow), which follow those in `chunks`. Calls
/// makeRow(i, chunk) for each, ascending within each chunk; it appends row i. makeRow = makeRows()
/// is made once per thread's range. `firstRow`: a multiple of ChunkRows.
template <typename MakeRows>
void splitRows(
  Index firstRow, Index lastRow, SplitChunks& chunks, Monitor& monitor, const MakeRows& makeRows)
{
  const Index before = firstRow / ChunkRows, count = chunksOf(lastRow - firstRow);
  chunks.interior.chunks.resize(before + count);
  chunks.coupling.chunks.resize(before + count);
  monitor.parallelFor(count, 1,
    [&](Index first, Index last)
    {
      auto makeRow = makeRows();
      SplitRows scratch; // keeps its capacity between chunks
      // Two arenas: the parts are joined, and freed, one after the other.
      std::shared_ptr<PageArena> interior, coupling;
      for (Index c = first; c < last; ++c)
      {
        if ((c - first) % ChunksOfArena == 0)
        {
          interior = std::make_shared<PageArena>();
          coupling = std::make_shared<PageArena>();
        }
        scratch.clear();
        const Index start = firstRow + c * ChunkRows, end = std::min(lastRow, start + ChunkRows);
        for (Index i = start; i < end; ++i)
        {
          makeRow(i, scratch);
        }
        chunks.interior.chunks[before + c] = { scratch.interior, interior };
        chunks.coupling.chunks[before + c] = { scratch.coupling, coupling };
      }
    });
}
}
