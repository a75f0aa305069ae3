// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Energies/TargetMatrices.h"
#include "Optimization/Minimizers.h"
#include "Optimization/NodePreconditioner.h"

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
  /// `mesh`: the reference shapes; `orientation`: #cells, see cellSigns() in Topology.h; `free`:
  /// ids of the nodes that may move, ascending; `preconditioner`: for Newton's linear systems of
  /// the whole mesh, by unknownOrdering(); null: none. Holds all by reference.
  Untangling(const Mesh& mesh, const std::vector<std::int8_t>& orientation,
    const std::vector<Index>& free, const NodePreconditioner* preconditioner,
    const Communicator& communicator = Communicator::alone())
    : mesh_(mesh)
    , orientation_(orientation)
    , free_(free)
    , preconditioner_(preconditioner)
    , communicator_(communicator)
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
  const Mesh& mesh_;
  const std::vector<std::int8_t>& orientation_;
  const std::vector<Index>& free_;
  const NodePreconditioner* preconditioner_;
  const Communicator& communicator_;
};
}
