// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LinearMethods/FemWarp.h"
#include "LinearMethods/NodeSliding.h"

#include <vector>

namespace morph
{
/// Moves nodes along the surfaces that they are on, until FEMWARP pulls none of them along its
/// surface. The pull on a node is its row of the stiffness matrix times the displacements of all
/// nodes. On a plane of symmetry no pull along the plane is the natural boundary condition.
class SlidingWarp : public FemWarp
{
public:
  using Row = NodeSliding::Row;
  using Surfaces = NodeSliding::Surfaces;
  using Round = NodeSliding::Round;
  using Limits = NodeSliding::Limits;

  /// Moves the sliding nodes in `moved`, #nodes x 3, where they and the prescribed nodes are; the
  /// others are not read. `sliding`: nodes, ascending; those that are not free, or count on another
  /// process, stay. `surfaces`: by the index in `sliding`. A round solves for all unknowns, with
  /// sliding nodes free along the surface at their present place, and puts them back onto the
  /// surface. If the pull has not become less, the move is halved, up to four times; then the
  /// rounds end. They end, too, where the pull is that of rounding. So it falls each round. Nodes
  /// without a pull keep their bits. Returns what each round has done. Cost: one solution, and two
  /// to six a round. Collective.
  std::vector<Round> slide(const std::vector<Index>& sliding, const Surfaces& surfaces,
    const Limits& limits, Points& moved, Monitor& monitor) const;
};
}
