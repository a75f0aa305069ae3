// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Quality/ScaledJacobian.h"

#include <functional>
#include <vector>

namespace morph
{
/// Takes back what lowered the minimum of the scaled Jacobian. Free corners of cells below the
/// minimum of `start` go back to where they were in it, until no cell is below; where `start`
/// itself is not valid nothing happens. `start`, `points`: #nodes x 3, alike at the nodes that are
/// not `free` (ids, ascending). `measure`: the quality of such points, which may set followers.
/// Returns how many nodes went back. Cost: a measurement for each layer of cells that goes back;
/// the first that is not enough after 30 takes all nodes back.
Index keepMinimum(const Mesh& mesh, const std::vector<Index>& free, const Points& start,
  Points& points, const std::function<Quality(Points&)>& measure);
}
