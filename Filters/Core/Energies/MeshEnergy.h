// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Energies/CellBatches.h"
#include "Energies/EnergyState.h"
#include "Energies/TargetMatrices.h"
#include "Optimization/Objective.h"

#include <vector>

namespace morph
{
/// The energy of a mesh: the weighted mean of a density over the tetrahedra of all cells. The
/// density is the foldover-free one, or the condition number. Tetrahedra without a free node are
/// left out, as they are constant. Not thread-safe.
class MeshEnergy : public SecondOrderObjective
{
public:
  /// `free`: ids of the nodes that move, ascending; free() has them in the order of
  /// unknownOrdering(). Cost: passes over the cells; 100 bytes a cell. On several processes `mesh`
  /// has the cells of this one.
  MeshEnergy(const Mesh& mesh, const std::vector<Index>& free,
    const Communicator& communicator = Communicator::alone());

  /// Sets the target shapes, weights and theta; required before the functions below.
  /// Memory: 24 bytes a corner of each cell.
  void setTargets(const TargetMatrices& targets)
  {
    this->batches_.setTargets(targets);
    this->density_.theta = targets.theta;
  }
  /// Sets the regularisation; theta is that of the targets. With a regularisation below 1e-9 no
  /// step may end with an inverted tetrahedron. With a larger one a mesh without any is enough.
  void setDensity(const FoldoverDensity& density)
  {
    this->density_.epsilon = density.epsilon;
    this->isCondition_ = false;
  }
  /// Takes the condition number, in which theta has no part. No step may end with an inverted
  /// tetrahedron.
  void setDensity(const ConditionDensity&) { this->isCondition_ = true; }
  /// The foldover-free density that was last set, with the targets' theta.
  const FoldoverDensity& density() const { return this->density_; }

  EnergyState evaluate(const Points& points, Monitor& monitor) const;

  const std::vector<Index>& free() const override { return this->free_; }
  Value value(const Points& points, Monitor& monitor) const override;
  void gradient(const Points& points, Points& result, Monitor& monitor) const override;
  void hessian(const Points& points, BlockCsr3f& result, Monitor& monitor) const override;

private:
  PatternId pattern_; ///< of the second derivatives
  std::vector<Index> free_;
  CellBatches batches_;
  mutable Points parts_; ///< of the gradient, kept between calls
  FoldoverDensity density_;
  bool isCondition_ = false; ///< the density is the condition number
};
}
