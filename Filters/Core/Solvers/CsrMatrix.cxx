// SPDX-License-Identifier: BSD-3-Clause
#include "Solvers/CsrMatrix.h"

#include "Support/Error.h"

#include <limits>
#include <numeric>

namespace morph
{
void requireEntries(Index entries)
{
  if (entries > std::numeric_limits<int>::max())
  {
    throw Error("The mesh is too large: its matrix has " + std::to_string(entries) +
                " entries, more than the solver can number (2^31 - 1).");
  }
}

void allocateRows(CsrMatrix& matrix, Index width, const std::vector<int>& sizes)
{
  const Index entries = std::accumulate(sizes.begin(), sizes.end(), Index(0));
  requireEntries(entries);
  matrix.resize(static_cast<Index>(sizes.size()) - 1, width);
  std::partial_sum(sizes.begin(), sizes.end(), matrix.outerIndexPtr());
  matrix.resizeNonZeros(entries);
}
}
