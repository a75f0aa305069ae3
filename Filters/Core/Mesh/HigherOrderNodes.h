// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/NodePartition.h"

#include <Eigen/SparseCore>

namespace morph
{
/// Moves the mid-side, face and body nodes of quadratic cells that are not prescribed. Each node
/// keeps its parametric position in the linear cell through the corners. The cell's shape functions
/// there interpolate the corners' displacements, so affine motions move curved edges exactly. A
/// node shared by several cells takes their mean.
///
/// If the parametric position cannot be found (a node far outside, a flat cell), the weights are
/// those at the nominal position. The smallest change that reproduces affine motions exactly is
/// added; a cell without volume gets none.
class HigherOrderNodes
{
public:
  /// Computes the weights from the undeformed mesh. Cost: a few Newton steps a node and cell.
  void prepare(const Mesh& rest, const NodePartition& partition);
  bool empty() const { return this->ids_.empty(); }
  /// Fills the higher-order nodes' rows of `displacement` (#nodes x 3) from the corners' rows.
  void apply(Points& displacement) const;
  /// The adjoint of apply(): adds the higher-order nodes' rows to the corners' rows by the same
  /// weights, and sets them to zero.
  void applyTranspose(Points& gradient) const;

private:
  std::vector<Index> ids_;
  Eigen::SparseMatrix<double, Eigen::RowMajor, int> weights_; ///< #higherOrderNodes x #nodes
};
}
