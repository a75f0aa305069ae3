// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Support/Monitor.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// How much higher than `least` a mesh's minimum scaled Jacobian has to be to count as a gain: 0.1
/// % of it, or 1 % of the way to 1 where that is less, and 1e-6 anyway. Less than that is not worth
/// what it costs the other cells.
double significantGain(double least);

/// Raises the minimum scaled Jacobian of a valid mesh: nodes within two rings of the worst cells
/// move to lower their WorstCornerNorm (L-BFGS, 40 steps a round), for up to 16 rounds, until two
/// in a row have not raised it by significantGain() or the worst cell has no free node, which no
/// mesh betters. `free`: ids of nodes that may move, ascending; `points`: #nodes x 3, in and out:
/// the best that was met. The mesh stays valid. Returns how many rounds have raised the least.
/// Cost: a pass over the cells a round, and the patches'.
int raiseMinimumQuality(const Mesh& mesh, const std::vector<std::int8_t>& orientation,
  const std::vector<Index>& free, Points& points, Monitor& monitor);
}
