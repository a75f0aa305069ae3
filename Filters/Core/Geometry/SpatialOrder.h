// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

#include <vector>

namespace morph
{
/// Sorts `ids` along a space-filling curve (Morton's, with 2^21 steps a side). Nodes near in the
/// list are near in space, whatever their numbering. Nodes at one position keep their order in
/// `ids`. Cost: a sort.
std::vector<Index> spatialOrder(const Points& points, const std::vector<Index>& ids);
}
