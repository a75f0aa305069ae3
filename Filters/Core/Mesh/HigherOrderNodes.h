// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/NodePartition.h"

#include <Eigen/SparseCore>

namespace morph
{
/// The mid-side, face and body nodes of quadratic cells that nobody prescribes. They keep their
/// place in the parametric cell: the linear cell through the corners is inverted at the node's rest
/// position, and its shape functions there carry the corners' displacements over, so an affine
/// motion carries curved edges along exactly. A node shared by several cells takes their mean.
/// Where the cell cannot be inverted (the node far outside, no volume) the weights are those at the
/// nominal place, with the least change after which affine motions stay exact (none in a cell of no
/// volume).
class HigherOrderNodes
{
public:
  /// Cost: a few Newton steps per higher-order node and cell.
  void prepare(const Mesh& rest, const NodePartition& partition);
  bool empty() const { return this->ids_.empty(); }
  /// `displacement`: #nodes x 3; fills the higher-order nodes' rows from the corners' rows.
  void apply(Points& displacement) const;
  /// Adds the higher-order nodes' rows to the corners' rows, by the same weights, and sets them to
  /// zero.
  void applyTranspose(Points& gradient) const;

private:
  std::vector<Index> ids_;
  Eigen::SparseMatrix<double, Eigen::RowMajor, Index> weights_; ///< #higherOrderNodes x #nodes
};
}
