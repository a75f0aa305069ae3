// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "NodePartition.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// Cells that the prescribed positions invert whatever the free nodes do: those with a corner whose four nodes, the corner and its
/// neighbors along the edges, are all prescribed and span no positive volume. Ids, ascending. `points`: #nodes x 3,
/// read at the prescribed nodes alone. `orientation`: #cells, see Topology's orientation(). Cost: one pass over the cells.
std::vector<Index> boundaryDeterminedInversions(const Mesh& mesh, const NodePartition& partition,
  const std::vector<std::int8_t>& orientation, const Points& points);
}
