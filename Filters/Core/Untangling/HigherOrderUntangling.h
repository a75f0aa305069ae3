// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/NodePartition.h"
#include "Support/Communicator.h"
#include "Support/Monitor.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// Untangles quadratic cells that are inverted although the cells through their corners have a
/// positive volume. The mid-side, face and body nodes of such cells move if they are not
/// prescribed; all corners stay. The nodes minimize what the Bernstein coefficients of the Jacobian
/// determinants (CellMap.h) of all quadratic cells around them lack of a margin, by its square. A
/// determinant is affine in a single node, so that penalty is convex in each node, and positive
/// coefficients certify a cell. The search ends once all are. If no fewer cells are inverted then,
/// by their certificates, all nodes stay. `orientation`: #cells, see cellSigns() in Topology.h;
/// `points`: #nodes x 3, start and result. The result does not depend on threads. Cost: certify(),
/// and some milliseconds a cell that is inverted. On several processes `mesh` has the cells of this
/// one, to which the numbers belong.
void untangleHigherOrder(const Mesh& mesh, const NodePartition& partition,
  const std::vector<std::int8_t>& orientation, Points& points, Monitor& monitor,
  const Communicator& processes = Communicator::alone());
}
