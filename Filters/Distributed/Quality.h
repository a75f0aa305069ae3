// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/Ranks.h"

#include "Quality/ScaledJacobian.h"

#include <cstdint>
#include <vector>

namespace morph::distributed
{
/// Returns the numbers of the whole mesh: minimum, mean, counts, and the global id of the worst
/// cell, the lowest one of those at the minimum. `mine`: of this rank's own cells. `cellIds`:
/// global, #cells at least. The scaled Jacobians of single cells are left out. Collective.
Quality reduce(const Ranks& ranks, const Quality& mine, const std::vector<std::int64_t>& cellIds);

/// morph::worstMean() of the cells of all ranks, the same on each of them. `mine`: of this rank's
/// own cells. Collective. Cost: a sort of this rank's values, and 64 reductions of one count.
double worstMean(const Ranks& ranks, const Quality& mine, double share = 0.01);
}
