// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Topology.h"
#include "Support/Monitor.h"

#include <cstdint>
#include <vector>

namespace morph
{
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
