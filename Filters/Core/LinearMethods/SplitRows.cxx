// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/SplitRows.h"

namespace morph
{
void joinRows(CsrMatrix& matrix, Index rows, Index width, SplitChunks::Part& part, Monitor& monitor)
{
  Index entries = 0;
  for (const StoredRows<double>& chunk : part)
  {
    entries += static_cast<Index>(chunk.entries());
  }
  allocateRows(matrix, rows, width, entries);
  int* start = matrix.outerIndexPtr();
  start[0] = 0;
  for (std::size_t c = 0; c < part.size(); ++c)
  {
    part[c].setEnds(start + static_cast<Index>(c) * ChunkRows);
  }
  monitor.parallelFor(static_cast<Index>(part.size()), 1,
    [&](Index first, Index last)
    {
      for (Index c = first; c < last; ++c)
      {
        const int at = start[c * ChunkRows];
        part[c].copyAndRelease(matrix.innerIndexPtr() + at, matrix.valuePtr() + at);
      }
    });
}
}
