// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LinearMethods/FemWarp.h"
#include "Solvers/LinearSolver.h"
#include "Support/Communicator.h"
#include "Support/Monitor.h"
#include "Support/Types.h"

#include <functional>
#include <vector>

namespace morph
{
/// The rounds of SlidingWarp.h, for equations A x = b on one process or several. Each process has
/// some of the rows.
class NodeSliding
{
public:
  using Row = Eigen::RowVector3d;

  /// The surfaces of the sliding nodes, by the index of a node.
  struct Surfaces
  {
    /// Returns the projection onto the directions along the surfaces at `x`: of rank 2 on one
    /// surface, 1 where two meet, 0 where the node cannot move.
    std::function<Eigen::Matrix3d(Index i, const Row& x)> directions;
    /// Returns the nearest point of the surfaces.
    std::function<Row(Index i, const Row& x)> closest;
  };

  struct Limits
  {
    int rounds = 0;           ///< at most so many
    double tolerance = 1e-11; ///< of the solutions, see solveConstrained(); in (0, 1)
  };

  /// What one round has done.
  struct Round
  {
    double change = 0; ///< the largest move of a node, in the unit of the points
    double force = 0;  ///< what is left of the pull, relative to that before the first round
  };

  /// The sliding nodes that have rows on this process.
  struct Nodes
  {
    std::vector<int> rows; ///< of each
    Points rest;           ///< #rows x 3
  };

  /// `solver`: of A; `b`: #rows x 3. Holds all arguments by reference.
  NodeSliding(const LinearSolver& solver, const Points& b, const Nodes& nodes,
    const Surfaces& surfaces, const Communicator& communicator = Communicator::alone());

  /// `x`: #rows x 3 displacements, which are read at the sliding nodes. Nodes without a pull keep
  /// their bits.
  std::vector<Round> run(const Limits& limits, Points& x, Monitor& monitor);

private:
  struct State;
  void solve(const RowConstraints& constraints, Points& x, Monitor& monitor);
  /// Finds the other unknowns, the sliding nodes' being given.
  void settle(State& state, Monitor& monitor);
  Row place(Index i, const Points& x) const;
  double norm(const Points& rows) const;

  const LinearSolver& solver_;
  const Points& b_;
  const Nodes& nodes_;
  const Surfaces& surfaces_;
  const Communicator& communicator_;
  double tolerance_ = 0;
  PointsVectors work_;
};

/// Moves nodes along the surfaces that they are on, until FEMWARP pulls none of them along its
/// surface. The pull on a node is its row of the stiffness matrix times the displacements of all
/// nodes. On a plane of symmetry no pull along the plane is the natural boundary condition.
class SlidingWarp : public FemWarp
{
public:
  using Row = NodeSliding::Row;
  using Surfaces = NodeSliding::Surfaces;
  using Round = NodeSliding::Round;
  using Limits = NodeSliding::Limits;

  /// Moves the sliding nodes in `moved`, #nodes x 3, where they and the prescribed nodes are; the
  /// others are not read. `sliding`: nodes, ascending; those that are not free, or count on another
  /// process, stay. `surfaces`: by the index in `sliding`. A round solves for all unknowns, with
  /// sliding nodes free along the surface at their present place, and puts them back onto the
  /// surface. If the pull has not become less, the move is halved, up to four times; then the
  /// rounds end. They end, too, where the pull is that of rounding. So it falls each round. Nodes
  /// without a pull keep their bits. Returns what each round has done. Cost: one solution, and two
  /// to six a round. Collective.
  std::vector<Round> slide(const std::vector<Index>& sliding, const Surfaces& surfaces,
    const Limits& limits, Points& moved, Monitor& monitor) const;
};
}
