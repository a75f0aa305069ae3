// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Adjacency.h"
#include "Support/FirstTouch.h"
#include "Support/Monitor.h"
#include "Support/Types.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
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
  Adjacency result;
  result.offsets = largeVector<Index>(rows + 1, 0, monitor);
  std::vector<Index>& offsets = result.offsets;
  const auto next = [](Index& count) { return __atomic_fetch_add(&count, 1, __ATOMIC_RELAXED); };
  monitor.parallelFor(producers, Grain,
    [&](Index first, Index last)
    { visit(first, last, [&](Index row, Index) { next(offsets[row + 1]); }); });
  std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
  resizeLarge(result.values, offsets.back(), monitor);
  // The starts become the ends of the rows, and are moved back below.
  monitor.parallelFor(producers, Grain,
    [&](Index first, Index last)
    {
      visit(
        first, last, [&](Index row, Index number) { result.values[next(offsets[row])] = number; });
    });
  std::copy_backward(offsets.begin(), offsets.end() - 1, offsets.end());
  offsets.front() = 0;
  monitor.parallelFor(rows, Grain,
    [&](Index first, Index last)
    {
      for (Index row = first; row < last; ++row)
      {
        const auto begin = result.values.begin() + offsets[row];
        const auto end = result.values.begin() + offsets[row + 1];
        if (!std::is_sorted(begin, end)) // it is where one thread ran
        {
          std::sort(begin, end);
        }
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
