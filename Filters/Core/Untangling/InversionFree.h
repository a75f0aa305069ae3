// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/Classification.h"
#include "Energies/TargetMatrices.h"
#include "LinearMethods/FemWarp.h"
#include "Mesh/OwnCells.h"
#include "Morpher/Morpher.h"
#include "Optimization/BlockCsr3f.h"
#include "Quality/MovableQuality.h"
#include "Untangling/Untangling.h"

#include <functional>
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
  /// For setSteps().
  static constexpr int NoSteps = 0, QuickSteps = 14, DefaultSteps = 40, ThoroughSteps = 200;

  /// Sets the tolerance of FEMWARP. Range (0, 1), default 1e-10.
  void setTolerance(double tolerance) { this->femWarp_.setTolerance(tolerance); }
  double tolerance() const { return this->femWarp_.tolerance(); }
  /// Sets how many steps may raise the minimum scaled Jacobian, see raiseQuality(): 0
  /// or more, default DefaultSteps.
  void setSteps(int steps) { this->steps_ = steps; }
  int steps() const { return this->steps_; }
  /// Sets whether the minimum of a mesh that needs no untangling rises, too. Default on. Off for
  /// pieces of polyhedra, as their minimum may rise while that of the polyhedra falls.
  void setRaisesValid(bool on) { this->raisesValid_ = on; }

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
  /// Below, coordinates are those times scale_. `hopeless`: cells, ascending, that the boundary
  /// inverts (boundaryDeterminedInversions()): the others are improved without them.
  MovableQuality quality(const std::vector<Index>& hopeless) const;
  /// Returns the minimum scaled Jacobian beyond which raising it is of no use, as the boundary
  /// holds that of the whole mesh there; infinite where it does not.
  double goal(const MovableQuality& quality, const Points& points) const;
  /// Untangles from `start`, whose inverted cells are `inverted`. At a folded face of the boundary
  /// (see foldedFaces()) either its cell or the neighbors are inverted. The mesh is then first
  /// untangled without the tetrahedra on folded faces, and next without those that stay inverted at
  /// two or more fixed nodes; from there with all, near the inverted ones. Keeps what is better.
  /// Returns the cells on folds.
  std::vector<Index> untangle(const Aim& aim, const std::vector<Index>& inverted,
    const Points& start, const std::function<bool(const Points& trial)>& keepBetter,
    MinimizerEffort& effort, Monitor& monitor) const;
  struct Outcome;
  /// Improves `points`, #nodes x 3. The result has no more inverted cells or, with as many, no
  /// lower minimum. `guide`: #nodes x 3, gives the targets' edge lengths. `target`: with which it
  /// is untangled; where that fails and the undeformed mesh is tangled, IdealSkew is next.
  /// `isRepair`: raises the minimum within ten rings of cells that were inverted alone.
  Outcome improve(const std::vector<Index>& hopeless, const Points& guide,
    TargetConstruction target, bool isRepair, Points& points, Monitor& monitor) const;
  /// Improves, again with the tangent planes of the result while a curved shell has inverted cells.
  Outcome improveInTurns(const std::vector<Index>& hopeless, const Points& guide,
    TargetConstruction target, bool isRepair, Points& points, Monitor& monitor) const;
  /// Warns of what stays inverted, and returns the counts. `determined`: cells that the boundary
  /// itself inverts, ascending. Ids are those of the whole mesh.
  static EvaluateReport report(
    const Outcome& outcome, const std::vector<Index>& determined, Monitor& monitor);
  /// Returns the method's mesh in coordinates times scale_.
  Points moved(
    const Morpher& method, const Points& boundary, EvaluateReport& report, Monitor& monitor) const;

  int steps_ = DefaultSteps;
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
  /// for Newton's linear systems of the whole mesh; null: FEMWARP's are not of the energy's rows
  std::unique_ptr<NodePreconditioner> preconditioner_;
  std::unique_ptr<Morpher> simplexLinear_; ///< null: a flat boundary has no tessellation
};
}
