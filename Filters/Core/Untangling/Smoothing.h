// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LinearMethods/FemWarp.h"
#include "Mesh/HigherOrderNodes.h"
#include "Mesh/OwnCells.h"
#include "Mesh/Topology.h"
#include "Morpher/Morpher.h"
#include "Morpher/ShellFits.h"
#include "Quality/ScaledJacobian.h"
#include "Untangling/SmoothMesh.h"

#include <memory>

namespace morph
{
/// Smoothing as a morph: the boundary moves, free nodes follow by an affine map, and the mesh is
/// smoothed. The map fits each body's motion (BodyMotion.h); if it inverts more cells than leaving
/// free nodes in place, they stay. Inverted cells are untangled first. See smoothMesh() for the
/// stages, their sources and their cost. Source: section 3.1 of Staten et al., Proc. 20th Int.
/// Meshing Roundtable (2011) 293-311, which starts from the undeformed nodes.
///
/// Only smoothing carries the part of the motion that is not affine into the mesh. So a motion by
/// more than a layer of cells may leave cells that cannot be untangled, with a warning.
///
/// With the target Ideal, the paper's, a boundary that does not move gives the smoothed mesh. No
/// other method differs from the identity there. With the target Initial a valid undeformed mesh
/// then stays bit for bit. Affine motions are reproduced to the tolerance of the minimization. If
/// the boundary stays or moves affinely, the minimum scaled Jacobian never falls below that of a
/// valid affine image. Nodes around cells that fell below it return to the image (SmoothMesh.h;
/// count `NodesTakenBack`).
///
/// Counts: `UntangleSteps`, `NewtonSteps`, `LinearIterations`, `EnergyEvaluations`,
/// `SmoothingPatches`, `NodesTakenBack`, `ConditionSteps` (of the Newton steps, those on the
/// condition number), `BoundaryDeterminedCells` (inverted by the boundary alone). The result is not
/// linear in the boundary, so there is no adjoint.
class Smoothing : public Morpher
{
public:
  /// Call it before evaluate().
  void setOptions(const SmoothingOptions& options) { this->options_ = options; }
  const SmoothingOptions& options() const { return this->options_; }
  void takeEvaluateOptions(const Morpher& other) override
  {
    this->options_ = static_cast<const Smoothing&>(other).options_;
  }
  int layers() const override { return 1; }

protected:
  void doPrepare(const Mesh& rest, Monitor& monitor) override;
  EvaluateReport displace(const Points& prescribed, Points& free, Monitor& monitor) const override;

private:
  // Of own_; `points` are #nodes x 3, `prescribed` #prescribed x 3 displacements.
  bool isIdentity(const Points& prescribed, Monitor& monitor) const;
  /// Measures `points` after setting their higher-order nodes. The counts and the minimum are those
  /// of the whole mesh.
  Quality measure(Points& points, Monitor& monitor) const;
  /// Sets the free nodes of `points` (undeformed, with the prescribed nodes moved) to the start.
  /// Returns whether both the boundary and the start move affinely.
  bool start(const Points& prescribed, Points& points, Monitor& monitor) const;
  /// The same of a curved shell. `prescribed`: displacements of partition().prescribed.
  bool startOfShell(const Points& prescribed, Points& points, Monitor& monitor) const;

  SmoothingOptions options_;
  std::unique_ptr<OwnCells> own_;
  ConnectedComponents bodies_; ///< of own_
  HigherOrderNodes followers_; ///< of own_
  /// Where nodes of a curved shell start; null for other meshes. They then move in tangent planes,
  /// so that the surface has to be where it belongs.
  std::unique_ptr<FemWarp> membrane_;
  ShellFits membraneFits_; ///< of the same, by which an affine motion is known
};
}
