// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Energies/TargetMatrices.h"
#include "Mesh/OwnCells.h"
#include "Optimization/BlockCsr3f.h"
#include "Optimization/Minimizers.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// What the cells' targets are made from, see targetMatrices().
struct Aim
{
  const Points& guide; ///< #nodes x 3
  TargetConstruction target;
  /// #cells: tetrahedron t counts only if bit t is set, see TargetMatrices
  const std::vector<std::uint32_t>& included;
};

/// Makes the cells of a mesh valid by a foldover-free energy.
class Untangling
{
public:
  /// `own`: the reference shapes, with edges about 1 long. `preconditioner`: for Newton's linear
  /// systems of the whole mesh, by unknownOrdering(); null: none. Holds both by reference.
  Untangling(const OwnCells& own, const NodePreconditioner* preconditioner)
    : own_(own)
    , preconditioner_(preconditioner)
  {
  }

  /// The targets of all cells. All count alike, so that those of a boundary layer are untangled,
  /// too.
  TargetMatrices targets(const Aim& aim, Monitor& monitor) const;

  /// Untangles `points`, #nodes x 3, by moving the nodes within 2 rings of the cells `seeds`. Next
  /// move those within three times as many of what is left, until these are most of the mesh. Then
  /// all nodes move. `nearOnly`: whether it ends before, if there has been a smaller part; `points`
  /// then stay. Returns whether all tetrahedra that count are positive. `effort`: added to. Cost:
  /// that of the energy on a mesh of the parts alone, and passes over the nodes.
  bool run(std::vector<Index> seeds, const Aim& aim, bool nearOnly, Points& points,
    MinimizerEffort& effort, Monitor& monitor) const;

private:
  const OwnCells& own_;
  const NodePreconditioner* preconditioner_;
};
}
