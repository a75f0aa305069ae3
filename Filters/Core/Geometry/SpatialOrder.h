// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

#include <vector>

namespace morph
{
/// `ids` along a space-filling curve (Morton's, 2^21 steps a side): nodes near in the list are near
/// in space, whatever the mesh generator's numbering was. Equal places keep the order of `ids`.
/// Cost: a sort.
std::vector<Index> spatialOrder(const Points& points, const std::vector<Index>& ids);
}
