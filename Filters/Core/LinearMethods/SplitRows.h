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

/// Calls makeRow(i, chunk) for the rows in [0, rows), ascending within each chunk; it appends row
/// i. makeRow = makeRows() is made once per thread's range.
template <typename MakeRows>
SplitChunks splitRows(Index rows, Monitor& monitor, const MakeRows& makeRows)
{
  SplitChunks chunks;
  chunks.interior.resize(chunksOf(rows));
  chunks.coupling.resize(chunksOf(rows));
  monitor.parallelFor(chunksOf(rows), 1,
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
        const Index end = std::min(rows, (c + 1) * ChunkRows);
        for (Index i = c * ChunkRows; i < end; ++i)
        {
          makeRow(i, scratch);
        }
        chunks.interior[c] = { scratch.interior, interior };
        chunks.coupling[c] = { scratch.coupling, coupling };
      }
    });
  return chunks;
}

/// Moves a part of all chunks into `matrix`, which gets `rows` x `width`, and frees it.
void joinRows(
  CsrMatrix& matrix, Index rows, Index width, SplitChunks::Part& part, Monitor& monitor);
}
