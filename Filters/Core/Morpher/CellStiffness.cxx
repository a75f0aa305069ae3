// SPDX-License-Identifier: BSD-3-Clause
#include "Morpher/CellStiffness.h"

#include <tuple>

namespace morph
{
bool CellStiffness::operator==(const CellStiffness& other) const
{
  const auto all = [](const CellStiffness& s)
  { return std::tie(s.kind, s.exponent, s.walls, s.values, s.noWalls, s.areWallsGlobal); };
  return all(*this) == all(other);
}
}
