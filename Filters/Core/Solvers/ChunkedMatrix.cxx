// SPDX-License-Identifier: BSD-3-Clause
#include "Solvers/ChunkedMatrix.h"

namespace morph
{
Index ChunkedMatrix::entries() const
{
  Index entries = 0;
  for (const StoredRows<double>& chunk : this->chunks)
  {
    entries += static_cast<Index>(chunk.entries());
  }
  requireEntries(entries);
  return entries;
}

void ChunkedMatrix::setStarts(int* start) const
{
  start[0] = 0;
  for (std::size_t c = 0; c < this->chunks.size(); ++c)
  {
    this->chunks[c].setEnds(start + static_cast<Index>(c) * ChunkRows);
  }
}

void joinRows(ChunkedMatrix chunked, CsrMatrix& matrix, Monitor& monitor)
{
  allocateRows(matrix, chunked.rows, chunked.columns, chunked.entries());
  const int* start = matrix.outerIndexPtr();
  chunked.setStarts(matrix.outerIndexPtr());
  monitor.parallelFor(static_cast<Index>(chunked.chunks.size()), 1,
    [&](Index first, Index last)
    {
      for (Index c = first; c < last; ++c)
      {
        const int at = start[c * ChunkRows];
        chunked.chunks[c].copyAndRelease(matrix.innerIndexPtr() + at, matrix.valuePtr() + at);
      }
    });
}
}
