// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh.h"
#include "Monitor.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// Raises the least scaled Jacobian of a valid mesh: nodes within two rings of the worst cells move to lower their CornerAngles (L-BFGS,
/// 40 steps), for up to 6 rounds, as long as each raises it by 0.1 % or more. `free`: ids of nodes that may move, ascending; `points`:
/// #nodes x 3, in and out. The mesh stays valid. Returns the rounds that were kept. Cost: a pass over the cells a round, and the patches'.
int raiseWorstCells(const Mesh& mesh, const std::vector<std::int8_t>& orientation,
  const std::vector<Index>& free, Points& points, Monitor& monitor);
}
