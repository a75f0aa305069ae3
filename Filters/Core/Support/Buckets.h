// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Adjacency.h"
#include "Support/Monitor.h"
#include "Support/Parallel.h"
#include "Support/Types.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <vector>

namespace morph
{
/// Sorts numbers into rows, in parallel; they are ascending in each row. visit(first, last, add)
/// calls add(row, number) for the numbers of the producers in [first, last); it is called twice for
/// each producer. The result does not depend on threads. Cost: two atomic additions a number, and a
/// sort of each row.
template <typename Visit>
Adjacency sortIntoBuckets(Index producers, Index rows, Monitor& monitor, const Visit& visit)
{
  constexpr Index Grain = 4096;
  std::vector<std::atomic<Index>> next(rows + 1); // counts, and then the next free place of a row
  const auto take = [&](Index row) { return next[row].fetch_add(1, std::memory_order_relaxed); };
  monitor.parallelFor(producers, Grain,
    [&](Index first, Index last) { visit(first, last, [&](Index row, Index) { take(row); }); });
  Adjacency result;
  result.offsets.assign(rows + 1, 0);
  for (Index row = 0; row < rows; ++row)
  {
    result.offsets[row + 1] = result.offsets[row] + next[row];
    next[row] = result.offsets[row];
  }
  result.values.resize(result.offsets.back());
  monitor.parallelFor(producers, Grain,
    [&](Index first, Index last)
    { visit(first, last, [&](Index row, Index number) { result.values[take(row)] = number; }); });
  parallel(rows, monitor,
    [&](Index row)
    {
      const auto begin = result.values.begin() + result.offsets[row];
      const auto end = result.values.begin() + result.offsets[row + 1];
      if (!std::is_sorted(begin, end)) // it is where one thread ran
      {
        std::sort(begin, end);
      }
    });
  return result;
}

/// Removes repeated numbers from rows that ascend, as those of sortIntoBuckets() do. Cost: a pass.
inline void removeRepeated(Adjacency& lists)
{
  Index kept = 0, first = 0;
  for (std::size_t row = 0; row + 1 < lists.offsets.size(); ++row)
  {
    const Index last = lists.offsets[row + 1], firstKept = kept;
    for (; first < last; ++first)
    {
      if (kept == firstKept || lists.values[kept - 1] != lists.values[first])
      {
        lists.values[kept++] = lists.values[first];
      }
    }
    lists.offsets[row + 1] = kept;
  }
  lists.values.resize(kept);
}
}
