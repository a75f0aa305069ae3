// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/NodePartition.h"
#include "Support/Monitor.h"

#include <cstdint>
#include <vector>

namespace morph
{
struct HigherOrderUntangling
{
  Index movedNodes = 0;    ///< higher-order nodes
  std::vector<Index> left; ///< cells that stay inverted between their corners, ascending
};

/// Untangles quadratic cells that are inverted although their corners are positive. Their mid-side,
/// face and body nodes move if they are not prescribed; all corners stay. They move towards the
/// means of their corners first, no farther than needed. Where cells stay inverted, each of their
/// nodes in turn raises the minimum Bernstein coefficient of the Jacobian determinants around it
/// (CellMap.h), by a compass search. A determinant is affine in a single node, so that minimum
/// is concave, and a positive one certifies a cell. There are never more inverted cells than
/// before. `orientation`: #cells, see cellSigns() in Topology.h; `points`: #nodes x 3, start and
/// result. The result does not depend on threads. Cost: certify(), and some milliseconds for each
/// node that the compass moves.
HigherOrderUntangling untangleHigherOrder(const Mesh& mesh, const NodePartition& partition,
  const std::vector<std::int8_t>& orientation, Points& points, Monitor& monitor);
}
