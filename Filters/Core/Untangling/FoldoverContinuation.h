// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Energies/MeshEnergy.h"
#include "Optimization/Minimizers.h"

namespace morph
{
/// Minimizes a mesh's foldover-free energy by continuation in its regularisation. Source: Garanzha
/// et al., ACM Trans. Graph. 40(4) (2021), arXiv 2102.03069. `points`: #nodes x 3, start and
/// result.
class FoldoverContinuation
{
public:
  /// `preconditioner`: for Newton's linear systems, by the rows of `energy`; null: none.
  explicit FoldoverContinuation(
    MeshEnergy& energy, const NodePreconditioner* preconditioner = nullptr)
    : energy_(energy)
    , preconditioner_(preconditioner)
  {
  }

  /// Lowers the regularisation in at most `stages` stages, until no tetrahedron is inverted. Gives
  /// up after ten successive stages without progress, or three that have not lowered their energy
  /// by 1 % either, which soon ends it if the boundary admits no valid mesh. Progress means fewer
  /// inverted tetrahedra, or a minimum determinant raised by 5 %. Returns whether all tetrahedra
  /// are positive.
  bool untangle(Points& points, Monitor& monitor, int stages = 60);

  const MinimizerEffort& effort() const { return this->effort_; }
  /// Adds the effort of stages on a part of the mesh.
  void include(const MinimizerEffort& effort);

private:
  void setDensity(double epsilon);
  EnergyState evaluate(const Points& points, Monitor& monitor);

  MeshEnergy& energy_;
  const NodePreconditioner* preconditioner_;
  BlockCsr3f matrix_;
  MinimizerEffort effort_;
};
}
