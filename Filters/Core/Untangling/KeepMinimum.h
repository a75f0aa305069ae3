// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Quality/ScaledJacobian.h"
#include "Support/Communicator.h"

#include <functional>
#include <vector>

namespace morph
{
/// Reverts moves that lowered the minimum scaled Jacobian. Free corners of cells below the minimum
/// of `start` return to their position there, until no cell is below. Nothing happens if `start` is
/// not valid. `start`, `points`: #nodes x 3, equal at nodes that are not `free` (ids, ascending).
/// `measure`: returns the quality of points, and may set their higher-order nodes. On several
/// processes its minimum is that of all. Returns the number of reverted nodes of the whole mesh.
/// Cost: a measurement for each layer of reverted cells; after 30 layers all nodes are reverted.
Index keepMinimum(const Mesh& mesh, const std::vector<Index>& free, const Points& start,
  Points& points, const std::function<Quality(Points&)>& measure,
  const Communicator& communicator = Communicator::alone());
}
