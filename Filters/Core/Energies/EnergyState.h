// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

#include <algorithm>
#include <limits>

namespace morph
{
/// An energy at a mesh's nodes, and how its pieces are turned: tetrahedra of cells, or corners of
/// faces.
struct EnergyState
{
  double energy = 0;
  /// Relative to the targets; positive: no piece is inverted. Infinite without a piece.
  double minimumDeterminant = std::numeric_limits<double>::infinity();
  Index inverted = 0; ///< pieces whose determinant is not positive

  EnergyState& operator+=(const EnergyState& other)
  {
    this->energy += other.energy;
    this->minimumDeterminant = std::min(this->minimumDeterminant, other.minimumDeterminant);
    this->inverted += other.inverted;
    return *this;
  }
};
}
