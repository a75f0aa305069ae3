// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LinearMethods/FemWarp.h"
#include "Optimization/NodePreconditioner.h"

#include <Eigen/Core>

namespace morph
{
/// The multigrid cycle that FEMWARP has prepared, on the same nodes.
class WarpPreconditioner : public NodePreconditioner
{
public:
  /// `femWarp`: prepared, and prepared no more while this object lives.
  explicit WarpPreconditioner(const FemWarp& femWarp)
    : femWarp_(femWarp)
    , diagonal_(femWarp.solver().matrix().diagonal())
  {
  }
  void apply(const Points& from, Points& to, Monitor& monitor) const override
  {
    this->femWarp_.solver().precondition(from, to, monitor);
  }
  double diagonal(Index row) const override { return this->diagonal_[row]; }
  Index rows() const override { return this->diagonal_.size(); }

private:
  const FemWarp& femWarp_;
  Eigen::VectorXd diagonal_;
};
}
