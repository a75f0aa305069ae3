// SPDX-License-Identifier: BSD-3-Clause
#include "Solvers/CsrMatrix.h"

#include "Support/Error.h"
#include "Support/HugePages.h"

#include <limits>
#include <string>

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

void allocateRows(CsrMatrix& matrix, Index rows, Index width, Index entries)
{
  requireEntries(entries);
  matrix.resize(rows, width);
  matrix.resizeNonZeros(entries);
  adviseHugePages(matrix.innerIndexPtr(), entries * sizeof(int));
  adviseHugePages(matrix.valuePtr(), entries * sizeof(double));
}
}
