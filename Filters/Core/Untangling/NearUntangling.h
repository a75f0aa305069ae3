// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Energies/TargetMatrices.h"
#include "Untangling/FoldoverContinuation.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// What the cells' targets are made from, see targetMatrices().
struct Aim
{
  const Points& guide; ///< #nodes x 3
  TargetConstruction target;
  const std::vector<Index>& hopeless; ///< ids of cells that nothing can mend: they do not count
};

/// The targets of all cells, for untangling. All cells count alike, so that those of a boundary
/// layer are untangled, too.
TargetMatrices untanglingTargets(const Mesh& mesh, const std::vector<std::int8_t>& orientation,
  const Aim& aim, Monitor& monitor, const Communicator& communicator);

/// Untangles `points`, #nodes x 3, by moving only the nodes within 2 rings of inverted cells, then
/// within 5 and 15 rings of those that are left; `firstRings`: the first of these numbers. `mesh`:
/// the reference shapes; `free`: ids of the nodes that may move, ascending; `inverted`: ids of the
/// inverted cells. Returns whether all tetrahedra of these parts are positive; otherwise `points`
/// stay. Gives up at once if more than a tenth of all cells is inverted. Cost: that of the energy
/// on a mesh of the parts alone, and passes over the nodes. `effort`: added to.
bool untangleNear(const Mesh& mesh, const std::vector<std::int8_t>& orientation,
  const std::vector<Index>& free, const std::vector<Index>& inverted, int firstRings,
  const Aim& aim, Points& points, MinimizerEffort& effort, Monitor& monitor,
  const Communicator& communicator = Communicator::alone());
}
