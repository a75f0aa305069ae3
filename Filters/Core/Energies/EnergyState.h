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
  double minimumDeterminant = 0; ///< relative to the targets; positive: no piece is inverted
  Index inverted = 0;            ///< pieces whose determinant is not positive
};

/// What an EnergyState is summed up from.
struct EnergySum
{
  double energy = 0;
  double least = std::numeric_limits<double>::infinity(); ///< of the determinants
  double inverted = 0;
  EnergySum& operator+=(const EnergySum& other)
  {
    this->energy += other.energy;
    this->least = std::min(this->least, other.least);
    this->inverted += other.inverted;
    return *this;
  }
};
}
