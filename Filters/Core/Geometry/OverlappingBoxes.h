// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace morph
{
/// Returns the pairs of boxes that have a point in common, ascending, the lower number first. One
/// of each pair at least is chosen, and `isWanted` is true of it. `isChosen`: #boxes, nonzero for
/// a chosen box. Source: CGAL, box_intersection_d. Cost: n log^3 n and the pairs.
std::vector<std::array<Index, 2>> overlappingBoxes(const std::vector<Eigen::AlignedBox3d>& boxes,
  const std::vector<std::uint8_t>& isChosen, const std::function<bool(Index, Index)>& isWanted);
}
