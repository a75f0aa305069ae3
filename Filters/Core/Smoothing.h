// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Morpher.h"
#include "SmoothMesh.h"

namespace morph
{
/// Smoothing as a morph: the boundary moves, the nodes inside stay where they were and are then smoothed, untangled first
/// where the motion inverted cells (section 3.1 of Staten et al., Proc. 20th Int. Meshing Roundtable (2011)
/// 293-311). See smoothMesh() for the stages, their sources and their cost. Nothing carries the motion inside but the
/// smoothing itself: motions of more than the cells at the boundary tangle more than it can always undo. What it
/// cannot untangle comes back with a warning.
///
/// With the target Ideal, the paper's, the result for a boundary that does not move is the mesh smoothed, not the
/// mesh: alone among the methods it is not the identity then. With the target Initial it is, bit for bit, for a
/// mesh that is valid at rest, and affine motions are reproduced to the tolerance of the minimisation.
///
/// Counts: `UntangleSteps`, `NewtonSteps`, `LinearIterations`, `EnergyEvaluations`, `SmoothingPatches`,
/// `BoundaryDeterminedCells` (the boundary alone
/// inverts them). Not linear in the boundary: no adjoint.
class Smoothing : public Morpher
{
public:
  /// Before evaluate().
  void setOptions(const SmoothingOptions& options) { this->options_ = options; }

protected:
  void doPrepare(const Mesh& rest, Monitor& monitor) override;
  EvaluateReport displace(const Points& prescribed, Points& free, Monitor& monitor) const override;

private:
  bool isIdentity(const Points& prescribed, Monitor& monitor) const;

  SmoothingOptions options_;
  Mesh mesh_; ///< at rest
  std::vector<std::int8_t> orientation_;
};
}
