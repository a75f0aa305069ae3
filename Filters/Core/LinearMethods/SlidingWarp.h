// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/NodePartition.h"
#include "Solvers/CsrMatrix.h"
#include "Solvers/SpdSolver.h"
#include "Support/Monitor.h"

#include <functional>
#include <vector>

namespace morph
{
/// Moves nodes along the surfaces that they are on, until FEMWARP pulls none of them along its
/// surface. The pull on a node is its row of the stiffness matrix times the displacements of all
/// nodes. On a plane of symmetry no pull along the plane is the natural boundary condition.
class SlidingWarp
{
public:
  using Row = Eigen::RowVector3d;

  /// The surfaces of the sliding nodes, by the index of a node in slidingNodes().
  struct Surfaces
  {
    /// Returns the projection onto the directions along the surfaces at `x`: of rank 2 on one
    /// surface, 1 where two meet, 0 where the node cannot move.
    std::function<Eigen::Matrix3d(Index i, const Row& x)> directions;
    /// Returns the nearest point of the surfaces.
    std::function<Row(Index i, const Row& x)> closest;
  };

  /// What one round has done.
  struct Round
  {
    double change = 0; ///< the largest move of a node, in the unit of the points
    double force = 0;  ///< what is left of the pull, in parts of that before the first round
  };

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
  /// `rounds`: at most so many. Returns what each has done. Cost: one solution, and two to six a
  /// round.
  std::vector<Round> slide(
    const Surfaces& surfaces, int rounds, Points& moved, Monitor& monitor) const;

private:
  /// The unknown displacements, and the force on all of their nodes.
  struct State
  {
    Points x, force; ///< #rows x 3
    double pull = 0; ///< the norm of the force along the surfaces
  };
  /// Finds the other unknowns, the sliding nodes' being given.
  void settle(const Surfaces& surfaces, const Points& b, State& state, Monitor& monitor) const;
  Row place(Index i, const Points& x) const;

  Points points_; ///< undeformed
  std::vector<Index> prescribed_, sliding_;
  std::vector<Index> rows_;     ///< the node of each matrix row
  std::vector<int> slidingRow_; ///< of each sliding node
  CsrMatrix coupling_;          ///< #rows x #prescribed
  SpdSolver solver_;
};
}
