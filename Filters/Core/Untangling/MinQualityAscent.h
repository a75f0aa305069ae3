// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Support/Monitor.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// Returns the increase of a mesh's minimum scaled Jacobian `least` that counts as a gain. It is
/// the smaller of 0.1 % of `least` and 1 % of 1 - `least`, but 1e-6 or more. A smaller gain is not
/// worth its cost to the other cells.
double significantGain(double least);

/// Raises the minimum scaled Jacobian of a valid mesh, which stays valid. Nodes within two rings of
/// the worst cells move to lower their WorstCornerNorm (L-BFGS, 40 steps a round). It ends after 16
/// rounds, or two successive ones without significantGain(). It also ends if the worst cell has no
/// free node, since no mesh is then better. `free`: ids of nodes that may move, ascending;
/// `points`: #nodes x 3, start and best result. Returns the number of rounds with a gain. Cost: a
/// pass over the cells a round, and the minimisation near the worst cells.
int raiseMinimumQuality(const Mesh& mesh, const std::vector<std::int8_t>& orientation,
  const std::vector<Index>& free, Points& points, Monitor& monitor);
}
