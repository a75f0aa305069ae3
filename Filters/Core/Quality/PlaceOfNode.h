// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Geometry/CommonPoint.h"
#include "Mesh/NodePartition.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// The corners of cell `c` of which `node` alone is not prescribed: where it has to be for them to
/// be positive. `isPrescribed`: #nodes. `points`: #nodes x 3, read at prescribed nodes alone. Adds
/// to `result`.
void addHalfSpaces(const Mesh& mesh, const std::vector<std::int8_t>& orientation, Index c,
  Index node, const std::vector<char>& isPrescribed, const Points& points,
  std::vector<HalfSpace>& result);
}
