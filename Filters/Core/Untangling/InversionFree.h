// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/Classification.h"
#include "Energies/MeshEnergy.h"
#include "Energies/TargetMatrices.h"
#include "LinearMethods/FemWarp.h"
#include "LinearMethods/SimplexLinear.h"
#include "Morpher/Morpher.h"
#include "Untangling/MeshImprovement.h"
#include "Untangling/WarpPreconditioner.h"

#include <memory>
#include <utility>

namespace morph
{
/// The inversion-free morph: it removes inverted cells by a foldover-free energy, and raises the
/// minimum scaled Jacobian. It starts from the better of FEMWARP's and the simplex-linear mesh, or
/// from another first guess. If that mesh is valid, its minimum is raised at once
/// (MinQualityAscent.h), up to what the boundary allows (MovableQuality.h). Inverted cells are
/// first untangled by the energy of the cells near them. The energy of the whole mesh is minimised
/// only where a cell stays inverted, or the minimum below that bound and three quarters of the
/// undeformed mesh's; where most cells are tetrahedra only in the first case.
///
/// The energy (Garanzha et al., ACM Trans. Graph. 40(4) (2021), arXiv 2102.03069) is a mean over
/// the averaged simplicial decompositions of all cells. So a valid minimum passes the scaled
/// Jacobian's corner test. Hexahedra, wedges and pyramids aim for their undeformed shape, stretched
/// to the first guess's edge lengths; tetrahedra for their undeformed shape. Newton's method uses
/// the projected Hessian; then the minimum is raised again. The better mesh is the result, so with
/// stretched targets it is never below FEMWARP's and the simplex-linear one: it has no more
/// inverted cells, and with as many no lower minimum over what free nodes can change.
///
/// No method can repair cells that the boundary itself inverts (BoundaryDetermined.h): a warning
/// names them, and the other cells are morphed. If other cells stay inverted, the count `Untangled`
/// is 0. A warning names those on a folded face of the boundary (Untangling.h).
///
/// Counts: `NewtonSteps`, `LinearIterations`, `EnergyEvaluations`, `BoundaryDeterminedCells`,
/// `FoldedBoundaryCells`, `KeptLinear` and `Untangled` (1 or 0).
///
/// prepare(): as FEMWARP and simplex-linear, and passes over the cells. evaluate(): raising the
/// minimum takes passes over the cells, and 100 to 1000 over those around the worst ones. The
/// energy takes 5 to 40 Newton steps of 0.4 to 0.8 microseconds of processor time a tetrahedron
/// (ten a hexahedron), each with a linear solution. It temporarily takes 1.1 kB a hexahedron. The
/// result is not linear in the boundary, so there is no adjoint.
class InversionFree : public Morpher
{
public:
  enum class Start
  {
    FemWarp,
    Rest,  ///< the undeformed mesh, with its boundary moved
    Method ///< the method of setMethod()
  };
  /// Sets the first guess, before evaluate(). An inverted undeformed mesh starts from Rest instead
  /// of FemWarp. Default FemWarp.
  void setStart(Start start) { this->start_ = start; }
  Start start() const { return this->start_; }
  /// Sets the method of the first guess, not prepared, and the start to Method. Call it before
  /// prepare().
  void setMethod(std::unique_ptr<Morpher> method);
  /// Returns that method, or null, for one who takes this object's options alone.
  std::unique_ptr<Morpher> releaseMethod() { return std::move(this->method_); }
  /// Sets the target shape of cells other than tetrahedra, before evaluate(). Default Stretched.
  /// Initial reproduces affine motions of the boundary exactly, since FEMWARP's mesh is then
  /// stationary.
  void setTarget(TargetConstruction target) { this->target_ = target; }
  TargetConstruction target() const { return this->target_; }
  /// Sets the tolerance of FEMWARP. Range (0, 1), default 1e-10.
  void setTolerance(double tolerance) { this->femWarp_.setTolerance(tolerance); }
  double tolerance() const { return this->femWarp_.tolerance(); }
  /// Default Newton.
  void setMinimizer(FoldoverContinuation::Minimizer minimizer) { this->minimizer_ = minimizer; }
  /// Whether to raise the minimum scaled Jacobian (MinQualityAscent.h), at the expense of the mean;
  /// never for Initial. Default on.
  void setRaising(bool on) { this->raising_ = on; }
  FoldoverContinuation::Minimizer minimizer() const { return this->minimizer_; }
  bool raises() const { return this->raising_; }
  /// Sets how often the stretched targets are recomputed from the current mesh. Default 2.
  void setRefreshes(int refreshes) { this->refreshes_ = refreshes; }

  /// Sets whether repair() moves only nodes near inverted cells, or none where these cannot be
  /// untangled so. prepare() then takes passes over the cells alone, and evaluate() throws Error.
  /// Default off.
  void setNearOnly(bool on) { this->nearOnly_ = on; }

  void setReference(Points reference) override { this->reference_ = std::move(reference); }

  /// Repairs `moved`, another method's mesh, instead of evaluate(). `moved`: #nodes x 3, with the
  /// prescribed nodes in place. Where its inverted cells can be untangled by the nodes near them,
  /// no other node moves; then those within ten rings raise the minimum there. A valid mesh whose
  /// minimum scaled Jacobian is higher than the repaired one's stays. Quadratic cells that are
  /// inverted between their corners are untangled last (HigherOrderUntangling.h).
  EvaluateReport repair(Points& moved, Monitor& monitor) const;

protected:
  void doPrepare(const Mesh& rest, Monitor& monitor) override;
  EvaluateReport displace(const Points& prescribed, Points& free, Monitor& monitor) const override;

private:
  void prepareFemWarp(const Mesh& rest, Monitor& monitor);
  /// Replaces the start `points` by the graph-Laplace mesh if that has fewer inverted cells. Then
  /// the undeformed shapes are worth nothing, and `target` becomes IdealSkew instead of Stretched.
  void startFromGraph(
    Points& points, Points& alternative, TargetConstruction& target, Monitor& monitor) const;
  /// Returns FEMWARP's mesh `warped`, or simplex-linear's if that is better.
  Points betterGuess(const Points& warped, const Points& boundary, Monitor& monitor) const;
  /// Of coordinates times scale_.
  MeshImprovement improvement() const;
  /// Returns the method's mesh in coordinates times scale_.
  Points moved(
    const Morpher& method, const Points& boundary, EvaluateReport& report, Monitor& monitor) const;

  Start start_ = Start::FemWarp;
  TargetConstruction target_ = TargetConstruction::Stretched;
  FoldoverContinuation::Minimizer minimizer_ = FoldoverContinuation::Minimizer::Newton;
  bool raising_ = true;
  bool nearOnly_ = false;
  int refreshes_ = 2;

  Points reference_;
  Mesh referenceMesh_; ///< the reference, its coordinates times scale_
  double scale_ = 1;   ///< a power of two that makes edges about 1 long
  std::vector<std::int8_t> orientation_;
  BoundaryFaces boundary_;
  Classification geometry_; ///< of the undeformed boundary
  bool validAtRest_ = true;
  double minimumAtRest_ = 0; ///< of the scaled Jacobian
  FemWarp femWarp_;
  bool hasFemWarp_ = false; ///< a tangled mesh may leave a node without a cell that has volume
  std::unique_ptr<WarpPreconditioner> preconditioner_; ///< null: not of the energy's rows
  SimplexLinear simplexLinear_;
  bool hasSimplexLinear_ = false; ///< a flat boundary has no tessellation, for instance
  std::unique_ptr<Morpher> method_;
};
}
