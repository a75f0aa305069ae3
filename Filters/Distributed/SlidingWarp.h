// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/SystemMethod.h"

#include "LinearMethods/NodeSliding.h"

#include <vector>

namespace morph::distributed
{
/// morph::SlidingWarp on ranks, after prepare(), for which the sliding nodes are free. Conjugate
/// gradients by one V-cycle of BoomerAMG solve for the unknowns along their surfaces.
class SlidingWarp : public FemWarp
{
public:
  /// Moves the sliding nodes in `moved`, #local nodes x 3, where they and the prescribed nodes are.
  /// `sliding`: local nodes, ascending; each rank reads and moves those that it owns, which are
  /// unknowns. `surfaces`: by the index in `sliding`. Returns what each round has done. Throws
  /// Error on all ranks. Collective.
  std::vector<NodeSliding::Round> slide(const std::vector<Index>& sliding,
    const NodeSliding::Surfaces& surfaces, const NodeSliding::Limits& limits, Points& moved,
    Monitor& monitor) const;
};
}
