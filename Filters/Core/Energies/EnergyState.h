// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

#include <algorithm>
#include <limits>

namespace morph
{
/// The regularised foldover-free density of a map's Jacobian J, from 1 for a rotation upwards
/// (Garanzha et al., ACM Trans. Graph. 40(4) (2021), arXiv 2102.03069):
///
///   phi(J) = (1 - theta) / 3 |J|^2 / chi^(2/3) + theta / 2 (1 + det^2) / chi,
///   chi = (det + sqrt(epsilon^2 + det^2)) / 2.
///
/// It is finite for inverted maps while epsilon > 0, and steep enough there to remove inversions.
/// For epsilon towards 0 it becomes a barrier at det = 0.
struct FoldoverDensity
{
  double theta = 0.1;     ///< weight of the change of volume against that of shape, in [0, 1]
  double epsilon = 1e-10; ///< regularisation, above 0
};

/// The condition number of a map's Jacobian J, over 3: from 1 for a rotation upwards,
///
///   kappa(J) = |J| |J^-1| / 3 = |J| |cof J| / (3 det J),
///
/// with Frobenius norms. It is a barrier: infinite where det J is not positive. It does not depend
/// on the size of J. As J becomes flat it grows as 1 / det, and the inverse mean ratio as
/// det^(-2/3) alone, so it pays more for the worst cells. Source: L. A. Freitag, P. M. Knupp,
/// "Tetrahedral mesh improvement via optimization of the element condition number", Int. J. Numer.
/// Meth. Engng 53 (2002) 1377-1391.
struct ConditionDensity
{
};

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
