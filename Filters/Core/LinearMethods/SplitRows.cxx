// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/SplitRows.h"

namespace morph
{
void SplitRows::Part::clear()
{
  this->size.clear();
  this->column.clear();
  this->value.clear();
}

void SplitRows::clear()
{
  this->interior.clear();
  this->coupling.clear();
}

void joinRows(CsrMatrix& matrix, Index width, std::vector<SplitRows>& chunks,
  SplitRows::Part SplitRows::*part, Monitor& monitor)
{
  std::vector<int> sizes(1, 0);
  for (const SplitRows& chunk : chunks)
  {
    sizes.insert(sizes.end(), (chunk.*part).size.begin(), (chunk.*part).size.end());
  }
  allocateRows(matrix, width, sizes);
  monitor.parallelFor(static_cast<Index>(chunks.size()), 1,
    [&](Index first, Index last)
    {
      for (Index c = first; c < last; ++c)
      {
        SplitRows::Part& from = chunks[c].*part;
        const int at = matrix.outerIndexPtr()[c * SplitRows::ChunkRows];
        std::copy(from.column.begin(), from.column.end(), matrix.innerIndexPtr() + at);
        std::copy(from.value.begin(), from.value.end(), matrix.valuePtr() + at);
        from = {};
      }
    });
}
}
