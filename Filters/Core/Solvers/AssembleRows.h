// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Solvers/CsrMatrix.h"
#include "Solvers/CsrRows.h"
#include "Solvers/DenseColumnMap.h"
#include "Solvers/LocalColumnMap.h"
#include "Support/Monitor.h"
#include "Support/Types.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace morph
{
/// Assembles a matrix from its rows in chunks of a fixed size, so it does not depend on threads.
/// makeRow(i, add) calls add(column, value) in any order, also repeatedly for a column. Columns
/// have the order of their first call. `columns`: of the matrix. Cost: no memory beside the chunks'
/// rows, and 1 MiB a range of threads at most.
template <typename Scalar, typename MakeRow>
CsrRows<Scalar> assembleRows(int rows, int columns, Monitor& monitor, const MakeRow& makeRow)
{
  constexpr Index Grain = 4096;
  constexpr int FewColumns = 1 << 18; // a table of them stays in a core's cache
  struct Chunk
  {
    std::vector<int> size, column;
    std::vector<Scalar> value;
  };
  const Index chunks = (rows + Grain - 1) / Grain;
  std::vector<Chunk> parts(chunks);
  monitor.parallelFor(chunks, 1,
    [&](Index firstChunk, Index lastChunk)
    {
      Chunk scratch;                          // keeps its capacity between chunks
      const auto makeChunks = [&](auto local) // the columns in a row
      {
        for (Index c = firstChunk; c < lastChunk; ++c)
        {
          scratch.size.clear();
          scratch.column.clear();
          scratch.value.clear();
          const int last = static_cast<int>(std::min<Index>(rows, (c + 1) * Grain));
          for (int i = static_cast<int>(c * Grain); i < last; ++i)
          {
            const std::size_t start = scratch.column.size();
            local.clear();
            makeRow(i,
              [&](int column, Scalar value)
              {
                const std::size_t at = start + local.localIndex(column);
                if (at < scratch.column.size())
                {
                  scratch.value[at] += value;
                  return;
                }
                scratch.column.push_back(column);
                scratch.value.push_back(value);
              });
            scratch.size.push_back(static_cast<int>(scratch.column.size() - start));
          }
          parts[c] = scratch;
        }
      };
      if (columns <= FewColumns)
      {
        makeChunks(DenseColumnMap(columns));
      }
      else
      {
        makeChunks(LocalColumnMap());
      }
    });

  CsrRows<Scalar> result;
  result.rows = rows;
  result.ownStart.reserve(rows + 1);
  result.ownStart.push_back(0);
  std::vector<std::size_t> at(chunks + 1, 0);
  for (Index c = 0; c < chunks; ++c)
  {
    at[c + 1] = at[c] + parts[c].value.size();
    requireEntries(static_cast<Index>(at[c + 1]));
    for (int size : parts[c].size)
    {
      result.ownStart.push_back(result.ownStart.back() + size);
    }
  }
  result.ownColumn.resize(at[chunks]);
  result.ownValue.resize(at[chunks]);
  monitor.parallelFor(chunks, 1,
    [&](Index first, Index last)
    {
      for (Index c = first; c < last; ++c)
      {
        std::copy(parts[c].column.begin(), parts[c].column.end(), result.ownColumn.data() + at[c]);
        std::copy(parts[c].value.begin(), parts[c].value.end(), result.ownValue.data() + at[c]);
        parts[c] = {};
      }
    });
  result.adopt();
  return result;
}
}
