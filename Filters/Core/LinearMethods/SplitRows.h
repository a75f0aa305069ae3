// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Solvers/CsrMatrix.h"
#include "Support/Monitor.h"

#include <algorithm>
#include <vector>

namespace morph
{
/// Some rows of [A_I A_B] in the making, the two parts apart. Chunks of ChunkRows rows are made by
/// any thread and then joined, so that no thread needs scratch of the matrix's size.
struct SplitRows
{
  static constexpr Index ChunkRows = 4096;
  static Index chunksOf(Index rows) { return (rows + ChunkRows - 1) / ChunkRows; }

  /// One of the two matrices' part.
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

/// Calls makeRow(i, chunk) for the rows of [0, rows) in chunks, ascending within each; it appends
/// row i. makeRow = makeRows() is made once per thread's range.
template <typename MakeRows>
std::vector<SplitRows> splitRows(Index rows, Monitor& monitor, const MakeRows& makeRows)
{
  std::vector<SplitRows> chunks(SplitRows::chunksOf(rows));
  monitor.parallelFor(static_cast<Index>(chunks.size()), 1,
    [&](Index first, Index last)
    {
      auto makeRow = makeRows();
      SplitRows scratch; // keeps its capacity from chunk to chunk
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

/// Puts one part of all chunks, `part`, into `matrix`, which gets `width` columns, and frees it.
void joinRows(CsrMatrix& matrix, Index width, std::vector<SplitRows>& chunks,
  SplitRows::Part SplitRows::*part, Monitor& monitor);
}
