// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Monitor.h"
#include "Topology.h"

#include <functional>

namespace morph
{
/// Where nodes are used: for each of `rows` rows the places p in [0, places) with rowOf(p) equal to it, ascending; places whose row is
/// negative belong to none. Calls `rowOf` twice a place.
Adjacency placesOfRows(Index places, Index rows, const std::function<Index(Index place)>& rowOf);

/// `result`: becomes #rows x 3, for each row the sum of `parts` (#places x 3) over its places, in their order: no thread shows.
void sumOverPlaces(const Adjacency& places, const Points& parts, Points& result, Monitor& monitor);
}
