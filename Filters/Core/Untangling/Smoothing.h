// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Morpher/Morpher.h"
#include "Quality/ScaledJacobian.h"
#include "Untangling/SmoothMesh.h"

namespace morph
{
/// Smoothing as a morph. The boundary moves, the nodes inside follow by each body's nearest affine
/// map (BodyMotion.h), and the mesh is smoothed from there, untangled first where cells are
/// inverted (section 3.1 of Staten et al., Proc. 20th Int. Meshing Roundtable (2011) 293-311, which
/// starts from the undeformed nodes). Where that map inverts more cells than leaving the nodes
/// inside alone, they are left alone. See smoothMesh() for the stages, their sources and their
/// cost. Of what is not affine in the motion nothing carries inside but the smoothing itself: more
/// than a layer of cells tangles more than it can always undo. What it cannot untangle comes back
/// with a warning.
///
/// With the target Ideal, the paper's, the result for a boundary that does not move is the mesh
/// smoothed, not the mesh: alone among the methods it is not the identity then. With the target
/// Initial it is, bit for bit, for a mesh that is valid at rest, and affine motions are reproduced
/// to the tolerance of the minimisation. Where the boundary stays or moves affinely, the minimum of
/// the scaled Jacobian never falls below that of the affine image, if that is valid: nodes round
/// cells that did fall below go back to it (KeepMinimum.h; count `NodesTakenBack`).
///
/// Counts: `UntangleSteps`, `NewtonSteps`, `LinearIterations`, `EnergyEvaluations`,
/// `SmoothingPatches`, `NodesTakenBack`, `BoundaryDeterminedCells` (the boundary alone inverts
/// them). Not linear in the boundary: no adjoint.
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
  /// Of `points`, whose followers it sets.
  Quality measure(Points& points, Monitor& monitor) const;
  /// `points`: #nodes x 3, the prescribed nodes moved, the others at rest; the free ones become the
  /// start. Returns whether the boundary moves affinely, and the start does.
  bool start(const Points& prescribed, Points& points, Monitor& monitor) const;

  SmoothingOptions options_;
  Mesh mesh_; ///< at rest
  std::vector<std::int8_t> orientation_;
};
}
