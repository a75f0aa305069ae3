// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Solvers/CsrMatrix.h"
#include "Support/Monitor.h"

#include <algorithm>
#include <vector>

namespace morph
{
/// Rows of [A_I A_B] in two parts during assembly. Any thread makes chunks of ChunkRows rows, which
/// are then joined. So no thread needs buffers of the matrix's size.
struct SplitRows
{
  static constexpr Index ChunkRows = 4096;
  static Index chunksOf(Index rows) { return (rows + ChunkRows - 1) / ChunkRows; }

  struct Part
  {
    std::vector<int> size;   ///< entries per row
    std::vector<int> column; ///< ascending in each row
    std::vector<double> value;

    void clear();
  };
  Part interior, coupling;

  void clear();
};

/// Calls makeRow(i, chunk) for the rows in [0, rows), ascending within each chunk; it appends row
/// i. makeRow = makeRows() is made once per thread's range.
template <typename MakeRows>
std::vector<SplitRows> splitRows(Index rows, Monitor& monitor, const MakeRows& makeRows)
{
  std::vector<SplitRows> chunks(SplitRows::chunksOf(rows));
  monitor.parallelFor(static_cast<Index>(chunks.size()), 1,
    [&](Index first, Index last)
    {
      auto makeRow = makeRows();
      SplitRows scratch; // keeps its capacity between chunks
      for (Index c = first; c < last; ++c)
      {
        scratch.clear();
        const Index end = std::min(rows, (c + 1) * SplitRows::ChunkRows);
        for (Index i = c * SplitRows::ChunkRows; i < end; ++i)
        {
          makeRow(i, scratch);
        }
        chunks[c] = scratch;
      }
    });
  return chunks;
}

/// Moves `part` of all chunks into `matrix`, which gets `width` columns, and frees it.
void joinRows(CsrMatrix& matrix, Index width, std::vector<SplitRows>& chunks,
  SplitRows::Part SplitRows::*part, Monitor& monitor);
}
