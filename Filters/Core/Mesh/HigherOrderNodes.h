// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/NodePartition.h"
#include "Support/Communicator.h"

#include <Eigen/SparseCore>

#include <map>
#include <memory>
#include <vector>

namespace morph
{
/// Moves the mid-side, face and body nodes of quadratic cells that are not prescribed by weights of
/// their cell's corners. These are those of the affine fit to the corners of the node's own edge,
/// face or body: 1/4 and 3/4 at a quarter point. A node off its edge or face needs more. The
/// smallest change of all corners' weights then makes affine motions exact; a flat cell has none. A
/// node shared by several cells takes their mean. With a communicator each process has its own
/// cells; then prepare() and apply() are collective, and the others are not to be called.
class HigherOrderNodes
{
public:
  /// Computes the weights from the undeformed mesh. Cost: some microseconds a node and cell.
  void prepare(const Mesh& rest, const NodePartition& partition,
    const Communicator& communicator = Communicator::alone());
  /// Whether no process has such nodes.
  bool empty() const { return !this->rows_; }
  /// Fills the higher-order nodes' rows of `displacement` (#nodes x 3) from the corners' rows.
  void apply(Points& displacement) const;
  /// Puts these nodes of `points` where their corners' motion from `rest` takes them; #nodes x 3.
  void carry(const Points& rest, Points& points) const;
  /// The adjoint of apply(): adds the higher-order nodes' rows to the corners' rows by the same
  /// weights, and sets them to zero.
  void applyTranspose(Points& gradient) const;
  /// The corners that a node follows, with their weights; none for a node that is no follower.
  std::map<Index, double> weightsOf(Index node) const;

private:
  std::vector<Index> ids_;
  Eigen::SparseMatrix<double, Eigen::RowMajor, int> weights_; ///< #higherOrderNodes x #nodes
  std::shared_ptr<const CopiedRows> rows_;                    ///< of ids_; null without any
};
}
