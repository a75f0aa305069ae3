// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Monitor.h"
#include "Support/Parallel.h"
#include "Support/Types.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace morph
{
/// A compressed list of lists: list i is values[offsets[i]] to values[offsets[i + 1] - 1].
struct Adjacency
{
  std::vector<Index> offsets = { 0 };
  std::vector<Index> values;

  const Index* begin(Index i) const { return this->values.data() + this->offsets[i]; }
  const Index* end(Index i) const { return this->values.data() + this->offsets[i + 1]; }
  /// Appends a list.
  template <typename Iterator>
  void add(Iterator first, Iterator last)
  {
    this->values.insert(this->values.end(), first, last);
    this->offsets.push_back(static_cast<Index>(this->values.size()));
  }
};

/// Makes a list ascending, each of its values once.
template <typename List>
void sortUnique(List& list)
{
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

/// Numbers: first, first + 1, ...
template <typename Number = Index>
std::vector<Number> consecutive(std::size_t count, Number first = 0)
{
  std::vector<Number> numbers(count);
  std::iota(numbers.begin(), numbers.end(), first);
  return numbers;
}

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

/// Returns the inverse of a list of ids: for each of `nodes` nodes its index in `ids`, or -1.
std::vector<std::int32_t> inverseIndex(const std::vector<Index>& ids, Index nodes);

/// Returns for each of `rows` rows the places p in [0, places) with rowOf(p) equal to the row.
/// Places are ascending; a negative rowOf(p) leaves p out. Calls `rowOf` twice a place.
template <typename RowOf>
Adjacency gatherMap(Index places, Index rows, const RowOf& rowOf)
{
  Adjacency result;
  result.offsets.assign(rows + 1, 0);
  for (Index place = 0; place < places; ++place)
  {
    const Index row = rowOf(place);
    if (row >= 0)
    {
      ++result.offsets[row + 1];
    }
  }
  for (Index row = 0; row < rows; ++row)
  {
    result.offsets[row + 1] += result.offsets[row];
  }
  result.values.resize(result.offsets.back());
  std::vector<Index> at(result.offsets.begin(), result.offsets.end() - 1);
  for (Index place = 0; place < places; ++place)
  {
    const Index row = rowOf(place);
    if (row >= 0)
    {
      result.values[at[row]++] = place;
    }
  }
  return result;
}

/// Sums `parts` (#places x 3) over each row's places into `result`, which becomes #rows x 3. The
/// fixed order of each sum makes the result independent of threads.
void gatherSum(const Adjacency& places, const Points& parts, Points& result, Monitor& monitor);
}
