// SPDX-License-Identifier: BSD-3-Clause
#include "Morpher/CellStiffness.h"

#include <utility>

namespace morph
{
void StiffMorpher::setStiffness(CellStiffness stiffness)
{
  this->stiffness_ = std::move(stiffness);
}
}
