// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Topology.h"
#include "Support/Monitor.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace morph
{
/// The inverse of a list of ids: for each of `nodes` nodes its place in `ids`, or -1.
std::vector<std::int32_t> inverseIndex(const std::vector<Index>& ids, Index nodes);

/// Where nodes are used: for each of `rows` rows the places p in [0, places) with rowOf(p) equal to
/// it, ascending; places whose row is negative belong to none. Calls `rowOf` twice a place.
Adjacency gatherMap(Index places, Index rows, const std::function<Index(Index place)>& rowOf);

/// `result`: becomes #rows x 3, for each row the sum of `parts` (#places x 3) over its places, in
/// their order: no thread shows.
void gatherSum(const Adjacency& places, const Points& parts, Points& result, Monitor& monitor);
}
