// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Monitor.h"
#include "Support/Types.h"

#include <vector>

namespace morph
{
/// A displacement field of all nodes, and its weight.
struct WeightedMode
{
  const Points* mode = nullptr; ///< #nodes x 3, finite
  double weight = 0;            ///< finite
};

/// Sets `moved` to `rest` plus the weighted modes. `rest`, `moved`: #nodes x 3; `moved` may be the
/// same matrix as `rest`. Each node's sum is taken in the order of `modes`, so the result has the
/// same bits in any number of threads. A node that does not move keeps its bits. Modes of weight 0
/// are not read. Throws Error, leaving `moved` untouched, for a weight that is not finite or a mode
/// of another number of nodes. Cost: one pass over the modes, 24 bytes a node and mode.
void blend(
  const ConstPoints& rest, const std::vector<WeightedMode>& modes, Points& moved, Monitor& monitor);
}
