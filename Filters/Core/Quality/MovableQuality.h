// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Quality/ScaledJacobian.h"
#include "Support/Communicator.h"
#include "Support/Monitor.h"
#include "Support/Types.h"

#include <cstdint>
#include <limits>
#include <vector>

namespace morph
{
/// Measures a mesh by the samples of its volume cells that free nodes can change. The prescribed
/// nodes alone determine the others, so one badly placed prescribed node does not hide what a
/// method can improve. Samples are those of samplesOf().
class MovableQuality
{
public:
  /// `orientation`: #cells, see cellSigns() in Topology.h; `free`: ids of the nodes that move,
  /// ascending. Holds all by reference, but `hopeless`: ids of cells that do not count, as no free
  /// node can mend them. Cost: one pass over the cells. On several processes `mesh` has the cells
  /// of this one, and all numbers but those of cells are those of the whole mesh.
  MovableQuality(const Mesh& mesh, const std::vector<std::int8_t>& orientation,
    const std::vector<Index>& free, const Communicator& communicator = Communicator::alone(),
    const std::vector<Index>& hopeless = {});

  const Mesh& mesh() const { return this->mesh_; }
  const std::vector<std::int8_t>& orientation() const { return this->orientation_; }
  const std::vector<Index>& free() const { return this->free_; }
  const Communicator& communicator() const { return this->communicator_; }

  struct Result
  {
    std::vector<double> scaledJacobian; ///< #cells; NaN without a sample
    double minimum = 0;                 ///< infinite without a sample in the mesh
    Index inverted = 0;                 ///< cells with 0 or less, degenerate ones too

    /// Whether this mesh is worse: it has more inverted cells or, with as many, a lower minimum.
    bool operator<(const Result& other) const;
  };
  /// Measures the mesh at `points`, #nodes x 3, by corners alone. Cost: measureCorners().
  Result measure(const Points& points, Monitor& monitor) const;
  /// Measures `cells` again, ascending ids, as the nodes of no other cell have moved since. Cost: a
  /// measurement of these cells, and a pass over the numbers of all.
  void measureAgain(
    const std::vector<Index>& cells, const Points& points, Result& result, Monitor& monitor) const;

  /// Replaces `points` by `trial`, and `best`, what points measure, by that of the trial, if it is
  /// better. Returns whether it is.
  bool keepBetter(Points trial, Points& points, Result& best, Monitor& monitor) const;

  /// What the prescribed nodes alone allow; infinite where they set no limit.
  struct Bounds
  {
    /// the minimum over samples without a free node
    double fixed = std::numeric_limits<double>::infinity();
    /// an upper bound of the others' minimum, see scaledJacobianBound()
    double movable = std::numeric_limits<double>::infinity();
  };
  /// `points`: #nodes x 3, read at prescribed nodes. Cost: a pass over the cells at prescribed
  /// nodes.
  Bounds bounds(const Points& points) const;
  /// The first of bounds() alone, at a fraction of the cost.
  double fixedMinimum(const Points& points) const;

private:
  struct Cell
  {
    Index id;
    unsigned prescribed;     ///< corner nodes
    unsigned movable, fixed; ///< samples
  };
  void cornersOf(Index cell, const Points& points, double (*x)[3]) const;
  /// Sets what depends on all cells.
  void summarize(Result& result) const;

  const Mesh& mesh_;
  const std::vector<std::int8_t>& orientation_;
  const std::vector<Index>& free_;
  const Communicator& communicator_;
  std::vector<Cell> held_;         ///< cells with three or more prescribed corner nodes, ascending
  std::vector<std::uint8_t> skip_; ///< #cells, nonzero for cells without a movable sample
};
}
