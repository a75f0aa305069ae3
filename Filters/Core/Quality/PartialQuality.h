// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Quality/ScaledJacobian.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// As measureQuality(), of some cells alone. `cells`: their ids, ascending, each once. All others
/// get NaN and are not counted. Cost: that of measureQuality() for these cells, and a pass over the
/// types and values of all.
Quality measureQualityOf(const Mesh& mesh, const ConstPoints& points,
  const std::vector<std::int8_t>& orientation, const std::vector<Index>& cells,
  const std::vector<std::uint8_t>& skip, Monitor& monitor);
}
