// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Geometry/CommonPoint.h"
#include "Mesh/NodePartition.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// Adds to `result` the half-spaces where `node` makes its corners of cell `c` positive. It takes
/// the corners whose nodes are all prescribed except `node`. `isPrescribed`: #nodes. `points`:
/// #nodes x 3, read only at prescribed nodes.
void addHalfSpaces(const Mesh& mesh, const std::vector<std::int8_t>& orientation, Index c,
  Index node, const std::vector<char>& isPrescribed, const Points& points,
  std::vector<HalfSpace>& result);
}
