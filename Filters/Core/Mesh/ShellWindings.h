// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Support/Communicator.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// The area vector of a triangle or quadrilateral. `points`: #nodes x 3.
Eigen::RowVector3d areaOf(const Points& points, const std::vector<Index>& corners);

/// Whether each front is wound as its neighbors, across edges of two fronts, are on the whole: 1 or
/// -1, and 0 for other cells. Sheets that meet at edges of more fronts are related by one of these.
/// Most of the area of what hangs together is wound right, in a plane about its normal. `points`:
/// of the front.
std::vector<std::int8_t> windingsOf(
  const Mesh& shell, const Points& points, const Communicator& processes);
}
