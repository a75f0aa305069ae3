// SPDX-License-Identifier: BSD-3-Clause
#include "Morpher/CellStiffness.h"

#include <tuple>
#include <utility>

namespace morph
{
bool CellStiffness::operator==(const CellStiffness& other) const
{
  const auto all = [](const CellStiffness& s)
  { return std::tie(s.kind, s.exponent, s.walls, s.values, s.noWalls, s.areWallsGlobal); };
  return all(*this) == all(other);
}

void StiffMorpher::setStiffness(CellStiffness stiffness)
{
  this->stiffness_ = std::move(stiffness);
}

bool StiffMorpher::hasPrepareOptionsOf(const Morpher& other) const
{
  return this->stiffness_ == static_cast<const StiffMorpher&>(other).stiffness_;
}
}
