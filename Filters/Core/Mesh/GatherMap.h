// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Topology.h"
#include "Support/Monitor.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace morph
{
/// Returns the inverse of a list of ids: for each of `nodes` nodes its index in `ids`, or -1.
std::vector<std::int32_t> inverseIndex(const std::vector<Index>& ids, Index nodes);

/// Returns for each of `rows` rows the places p in [0, places) with rowOf(p) equal to the row.
/// Places are ascending; a negative rowOf(p) leaves p out. Calls `rowOf` twice a place.
Adjacency gatherMap(Index places, Index rows, const std::function<Index(Index place)>& rowOf);

/// Sums `parts` (#places x 3) over each row's places into `result`, which becomes #rows x 3. The
/// fixed order of each sum makes the result independent of threads.
void gatherSum(const Adjacency& places, const Points& parts, Points& result, Monitor& monitor);
}
