// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LinearMethods/NodeSliding.h"
#include "Mesh/Mesh.h"
#include "Mesh/NodePartition.h"
#include "Solvers/CsrMatrix.h"
#include "Solvers/SpdSolver.h"
#include "Support/Monitor.h"

#include <vector>

namespace morph
{
/// Moves nodes along the surfaces that they are on, until FEMWARP pulls none of them along its
/// surface. The pull on a node is its row of the stiffness matrix times the displacements of all
/// nodes. On a plane of symmetry no pull along the plane is the natural boundary condition.
class SlidingWarp
{
public:
  using Row = NodeSliding::Row;
  using Surfaces = NodeSliding::Surfaces;
  using Round = NodeSliding::Round;
  using Limits = NodeSliding::Limits;

  /// Makes the equations of FEMWARP, for which `sliding` nodes are unknowns. `prescribed`: all
  /// nodes whose displacement is known, sorted. Sliding nodes that are no corner of a cell are
  /// left out. Throws Error as FemWarp::prepare() does. Cost: that of FemWarp::prepare().
  void prepare(const Mesh& rest, const std::vector<Index>& prescribed,
    const std::vector<Index>& sliding, Monitor& monitor);

  /// The sliding nodes that are unknowns, ascending.
  const std::vector<Index>& slidingNodes() const { return this->sliding_; }

  /// Moves the sliding nodes in `moved`, #nodes x 3, where they and the prescribed nodes are; the
  /// others are not read. A round solves for all unknowns, with sliding nodes free along the
  /// surface at their present place, and puts them back onto the surface. If the pull has not
  /// become less, the move is halved, up to four times; then the rounds end. They end, too, where
  /// the pull is that of rounding. So it falls each round. Nodes without a pull keep their bits.
  /// Returns what each round has done. Cost: one solution, and two to six a round.
  std::vector<Round> slide(
    const Surfaces& surfaces, const Limits& limits, Points& moved, Monitor& monitor) const;

private:
  Points points_; ///< undeformed
  std::vector<Index> prescribed_, sliding_;
  std::vector<Index> rows_;     ///< the node of each matrix row
  std::vector<int> slidingRow_; ///< of each sliding node
  CsrMatrix coupling_;          ///< #rows x #prescribed
  SpdSolver solver_;
};
}
