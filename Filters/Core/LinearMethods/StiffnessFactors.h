// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Morpher/CellStiffness.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace morph
{
/// Returns the stiffness of each cell, #cells, relative to the stiffest volume cell and at
/// least 1e-10; 1 for cells below dimension 3. Empty for Uniform without values.
/// `prescribed`: the walls where `stiffness` names none. Throws Error for an exponent outside [0,
/// 4], values that are not positive, finite and one a cell, and walls that are no nodes. Cost: a
/// pass over the cells; for WallDistance also a k-d tree of the walls.
std::vector<double> stiffnessFactors(const Mesh& mesh, const std::vector<Index>& prescribed,
  const CellStiffness& stiffness, Monitor& monitor);

/// A part of a mesh whose other parts are elsewhere.
struct StiffnessPart
{
  const std::vector<std::uint8_t>& isGhost; ///< #cells, nonzero for those of another part
  Points walls;                             ///< #walls x 3, of the whole mesh
  /// Of this part's number over all parts.
  ///@{
  std::function<double(double)> sum, maximum;
  ///@}
};
/// Returns the same for a part, as of the whole mesh. `stiffness`: its walls are not read, and its
/// values are of the part's cells; it is not Uniform without values. Calls `part.sum` and
/// `part.maximum` as often on each part.
std::vector<double> stiffnessFactors(
  const Mesh& mesh, const CellStiffness& stiffness, const StiffnessPart& part, Monitor& monitor);
}
