// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Solvers/CsrMatrix.h"
#include "Solvers/RowChunks.h"
#include "Support/Monitor.h"
#include "Support/Types.h"

#include <vector>

namespace morph
{
/// A matrix whose rows have been made, in chunks of ChunkRows that wait to be joined.
struct ChunkedMatrix
{
  Index rows = 0, columns = 0;
  std::vector<StoredRows<double>> chunks;

  /// The number of entries. Throws Error as requireEntries().
  Index entries() const;
  /// Sets `start`, #rows + 1, to where the rows begin among all entries.
  void setStarts(int* start) const;
};

/// Moves the rows into `matrix`, and frees the chunks one by one.
void joinRows(ChunkedMatrix chunked, CsrMatrix& matrix, Monitor& monitor);
}
