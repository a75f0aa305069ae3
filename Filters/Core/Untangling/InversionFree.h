// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/Classification.h"
#include "Energies/MeshEnergy.h"
#include "Energies/TargetMatrices.h"
#include "LinearMethods/FemWarp.h"
#include "Mesh/OwnCells.h"
#include "Morpher/Morpher.h"
#include "Untangling/MeshImprovement.h"
#include "Untangling/WarpPreconditioner.h"

#include <memory>
#include <utility>
#include <vector>

namespace morph
{
/// The inversion-free morph: it removes inverted cells by a foldover-free energy, and raises the
/// minimum scaled Jacobian. It starts from the better of FEMWARP's and the simplex-linear mesh. A
/// mesh that is inverted when undeformed has two more starts, its own nodes and the graph-Laplace
/// mesh.
///
/// Inverted cells are untangled by the energy of the cells near them, and else of all cells
/// (Garanzha et al., ACM Trans. Graph. 40(4) (2021), arXiv 2102.03069). Hexahedra, wedges and
/// pyramids aim for their undeformed shape, stretched to the start's edge lengths; tetrahedra for
/// their undeformed shape. It ends at the first mesh without an inverted tetrahedron of the cells'
/// decompositions. Then quasi-isometric stiffening raises the minimum, up to what the boundary
/// allows (QualityRaising.h, MovableQuality.h). The result has never more inverted cells than the
/// start and, with as many, no lower minimum over what free nodes can change.
///
/// No method can repair cells that the boundary itself inverts (BoundaryDetermined.h). A warning
/// names them, and the other cells are improved without them. If others stay inverted, the count
/// `Untangled` is 0. A warning names those on a folded face of the boundary (Untangling.h).
///
/// On several processes the stages are the same for the cells of each. The graph-Laplace mesh is no
/// start there, and a folded boundary is recognized by the outer faces of each process alone.
///
/// Counts: `NewtonSteps`, `LinearIterations`, `EnergyEvaluations`, `BoundaryDeterminedCells`,
/// `FoldedBoundaryCells` and `Untangled` (1 or 0).
///
/// prepare(): as FEMWARP and simplex-linear, and passes over the cells. evaluate(): a step on the
/// whole mesh takes 3 microseconds of processor time a hexahedron, and half as much memory again as
/// FEMWARP's. The result is not linear in the boundary, so there is no adjoint.
class InversionFree : public Morpher
{
public:
  /// Sets the tolerance of FEMWARP. Range (0, 1), default 1e-10.
  void setTolerance(double tolerance) { this->femWarp_.setTolerance(tolerance); }
  double tolerance() const { return this->femWarp_.tolerance(); }
  /// Sets how many steps may raise the minimum scaled Jacobian, 0 or more: see RaisingSteps.
  void setSteps(int steps) { this->steps_ = steps; }
  int steps() const { return this->steps_; }
  /// Sets whether the minimum of a mesh that needs no untangling rises, too. Default on. Off for
  /// pieces of polyhedra, as their minimum may rise while that of the polyhedra falls.
  void setRaisesValid(bool on) { this->raisesValid_ = on; }
  bool raisesValid() const { return this->raisesValid_; }

  /// Sets whether repair() moves only nodes near inverted cells, or none where these cannot be
  /// untangled so. prepare() then takes passes over the cells alone, and evaluate() throws Error.
  /// Default off.
  void setNearOnly(bool on) { this->nearOnly_ = on; }

  void takeEvaluateOptions(const Morpher& other) override;
  void setReference(Points reference) override { this->reference_ = std::move(reference); }
  int layers() const override { return 1; }

  /// Repairs `moved`, another method's mesh, instead of evaluate(). `moved`: #nodes x 3, with the
  /// prescribed nodes in place. Where its inverted cells can be untangled by the nodes near them,
  /// no other node moves; then those within ten rings raise the minimum there. A valid mesh whose
  /// minimum scaled Jacobian is higher than the repaired one's stays. Quadratic cells that are
  /// inverted between their corners are untangled last (HigherOrderUntangling.h).
  EvaluateReport repair(Points& moved, Monitor& monitor) const;

protected:
  void doPrepare(const Mesh& rest, Monitor& monitor) override;
  bool hasPrepareOptionsOf(const Morpher& other) const override
  {
    return this->nearOnly_ == static_cast<const InversionFree&>(other).nearOnly_;
  }
  EvaluateReport displace(const Points& prescribed, Points& free, Monitor& monitor) const override;

private:
  EvaluateReport repairHere(Points& moved, Monitor& monitor) const;
  void prepareFemWarp(const Mesh& rest, Monitor& monitor);
  /// Replaces `points`, the undeformed mesh with its boundary moved, by the best of the starts.
  /// Returns the target for which to untangle it.
  TargetConstruction findStart(const Points& boundary, const MovableQuality& quality,
    Points& points, EvaluateReport& report, Monitor& monitor) const;
  /// Of coordinates times scale_.
  MeshImprovement improvement(const std::vector<Index>& hopeless) const;
  /// MeshImprovement::run(), again with the tangent planes of its result while a curved shell has
  /// inverted cells.
  MeshImprovement::Outcome run(const MeshImprovement& improvement, const Points& guide,
    TargetConstruction target, bool isRepair, Points& points, Monitor& monitor) const;
  /// Returns the method's mesh in coordinates times scale_.
  Points moved(
    const Morpher& method, const Points& boundary, EvaluateReport& report, Monitor& monitor) const;

  int steps_ = RaisingSteps::Default;
  bool nearOnly_ = false;
  bool raisesValid_ = true;

  Points reference_;
  std::unique_ptr<OwnCells> own_; ///< of the reference, its coordinates times scale_
  double scale_ = 1;              ///< a power of two that makes edges about 1 long
  BoundaryFaces boundary_;        ///< of own_: the outer faces of the whole mesh
  Classification geometry_;       ///< of the undeformed boundary
  bool validAtRest_ = true;
  double minimumAtRest_ = 0; ///< of the scaled Jacobian
  FemWarp femWarp_;
  bool hasFemWarp_ = false; ///< a tangled mesh may leave a node without a cell that has volume
  std::unique_ptr<WarpPreconditioner> preconditioner_; ///< null: not of the energy's rows
  std::unique_ptr<Morpher> simplexLinear_; ///< null: a flat boundary has no tessellation
};
}
