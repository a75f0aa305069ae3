// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Solvers/CsrMatrix.h"
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

/// The chunks of both parts.
struct SplitChunks
{
  using Part = std::vector<StoredRows<double>>;
  Part interior, coupling;
};

/// Appends the chunks of the rows in [firstRow, lastRow), which follow those in `chunks`. Calls
/// makeRow(i, chunk) for each, ascending within each chunk; it appends row i. makeRow = makeRows()
/// is made once per thread's range. `firstRow`: a multiple of ChunkRows.
template <typename MakeRows>
void splitRows(
  Index firstRow, Index lastRow, SplitChunks& chunks, Monitor& monitor, const MakeRows& makeRows)
{
  const Index before = firstRow / ChunkRows, count = chunksOf(lastRow - firstRow);
  chunks.interior.resize(before + count);
  chunks.coupling.resize(before + count);
  monitor.parallelFor(count, 1,
    [&](Index first, Index last)
    {
      auto makeRow = makeRows();
      SplitRows scratch; // keeps its capacity between chunks
      // Two arenas, so that the interior's memory is freed before the coupling is joined.
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
        chunks.interior[before + c] = { scratch.interior, interior };
        chunks.coupling[before + c] = { scratch.coupling, coupling };
      }
    });
}

/// The chunks of the rows in [0, rows).
template <typename MakeRows>
SplitChunks splitRows(Index rows, Monitor& monitor, const MakeRows& makeRows)
{
  SplitChunks chunks;
  splitRows(0, rows, chunks, monitor, makeRows);
  return chunks;
}

/// Moves a part of all chunks into `matrix`, which gets `rows` x `width`, and frees it.
void joinRows(
  CsrMatrix& matrix, Index rows, Index width, SplitChunks::Part& part, Monitor& monitor);
}
