// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/Classification.h"
#include "Energies/MeshEnergy.h"
#include "Energies/TargetMatrices.h"
#include "LinearMethods/FemWarp.h"
#include "LinearMethods/SimplexLinear.h"
#include "Morpher/Morpher.h"
#include "Untangling/FoldoverContinuation.h"

#include <memory>

namespace morph
{
/// The inversion-free morph: from a first guess, FEMWARP's mesh or any other, a minimisation drives
/// inverted cells out and then improves the worst ones. The energy is that of Garanzha et al. (ACM
/// Trans. Graph. 40(4) (2021), arXiv 2102.03069) on the averaged simplicial decompositions of all
/// cells, so its minimum being positive implies the scaled Jacobian's corner test. Hexahedra,
/// wedges and pyramids aim for their shape at rest, stretched to FEMWARP's edge lengths; tetrahedra
/// for their shape at rest. Newton's method with the projected Hessian; once valid, stiffening (ACM
/// Trans. Graph. 43(1) (2024), arXiv 2201.12112) lowers the worst distortion. Where FEMWARP's mesh
/// is valid and its minimum scaled Jacobian higher, that is the result; with stretched targets the
/// simplex-linear mesh likewise. So the minimum is never below those two, but for rounding of the
/// coordinates.
///
/// Cells that the boundary itself inverts (BoundaryDetermined.h) are out of reach of any method: a
/// warning names them, and the rest of the mesh is morphed. Where cells stay inverted that are not
/// of these the count `Untangled` is 0; a warning names those of them that are on a face that the
/// boundary folds (Untangling.h).
///
/// Counts: `NewtonSteps`, `LinearIterations`, `EnergyEvaluations`, `BoundaryDeterminedCells`,
/// `FoldedBoundaryCells`, `KeptLinear` and `Untangled` (1 or 0).
///
/// prepare(): FEMWARP's and simplex-linear's, and passes over the cells. evaluate(): 10 to 60
/// Newton steps of 0.4 to 0.8 microseconds of processor time a tetrahedron (ten a hexahedron), and
/// a linear solution each; 4 kB a hexahedron meanwhile. Not linear in the boundary: no adjoint.
class InversionFree : public Morpher
{
public:
  enum class Start
  {
    FemWarp,
    Rest,  ///< the undeformed mesh, with its boundary moved
    Method ///< that of setMethod()
  };
  /// Before evaluate(). A mesh that is inverted at rest starts from rest instead of FEMWARP.
  /// Default FemWarp.
  void setStart(Start start) { this->start_ = start; }
  /// The method that makes the first guess, not prepared yet; sets the start to Method. Before
  /// prepare().
  void setMethod(std::unique_ptr<Morpher> method);
  /// What cells other than tetrahedra aim for. Before evaluate(). Default Stretched; with Initial
  /// affine motions of the boundary are reproduced exactly, since FEMWARP's mesh is stationary
  /// then.
  void setTarget(TargetConstruction target) { this->target_ = target; }
  /// Of FEMWARP. Range (0, 1), default 1e-10.
  void setTolerance(double tolerance) { this->femWarp_.setTolerance(tolerance); }
  /// Default Newton.
  void setMinimizer(FoldoverContinuation::Minimizer minimizer) { this->minimizer_ = minimizer; }
  /// Whether to lower the worst distortion in the end, and to raise the minimum scaled Jacobian
  /// (MinQualityAscent.h); never for Initial. Default on.
  void setStiffening(bool on) { this->stiffening_ = on; }
  /// How often the stretched targets are taken again from the mesh as it has become. Default 2.
  void setRefreshes(int refreshes) { this->refreshes_ = refreshes; }

  void setReference(Points reference) override { this->reference_ = std::move(reference); }

  /// Instead of evaluate(): repairs `moved` (#nodes x 3, the prescribed nodes where they have to
  /// be), which another method has made. A valid mesh whose minimum scaled Jacobian is higher than
  /// the repaired one's stays.
  EvaluateReport repair(Points& moved, Monitor& monitor) const;

protected:
  void doPrepare(const Mesh& rest, Monitor& monitor) override;
  EvaluateReport displace(const Points& prescribed, Points& free, Monitor& monitor) const override;

private:
  struct Outcome
  {
    bool untangled = false;
    bool kept = false;          ///< the alternative's positions
    std::vector<Index> onFolds; ///< inverted cells on folded faces of the boundary
    MinimizerEffort effort;
  };
  /// In coordinates times scale_. `guide`: see TargetMatrices; `alternative`: a mesh that the
  /// result must not be worse than.
  Outcome improve(
    Points& points, const Points& guide, const Points& alternative, Monitor& monitor) const;
  /// `warped`, FEMWARP's mesh, or that of simplex-linear if its minimum scaled Jacobian is higher.
  Points betterGuess(const Points& warped, const Points& boundary, Monitor& monitor) const;
  /// Of a valid mesh.
  void raiseQuality(
    MeshEnergy& energy, FoldoverContinuation& stages, Points& points, Monitor& monitor) const;
  /// The method's mesh, in coordinates times scale_.
  Points moved(
    const Morpher& method, const Points& boundary, EvaluateReport& report, Monitor& monitor) const;
  EvaluateReport report(
    const Outcome& outcome, const std::vector<Index>& determined, Monitor& monitor) const;
  void raiseWorst(Points& points, Monitor& monitor) const;
  double leastScaledJacobian(const Points& points, Monitor& monitor) const;

  Start start_ = Start::FemWarp;
  TargetConstruction target_ = TargetConstruction::Stretched;
  FoldoverContinuation::Minimizer minimizer_ = FoldoverContinuation::Minimizer::Newton;
  bool stiffening_ = true;
  int refreshes_ = 2;

  Points reference_;
  Mesh referenceMesh_; ///< the reference, its coordinates times scale_
  double scale_ = 1;   ///< a power of two that makes edges about 1 long
  std::vector<std::int8_t> orientation_;
  BoundaryFaces boundary_;
  Classification geometry_; ///< of the boundary at rest
  bool validAtRest_ = true;
  FemWarp femWarp_;
  SimplexLinear simplexLinear_;
  bool hasSimplexLinear_ = false; ///< it has no tessellation of a flat boundary, for one
  std::unique_ptr<Morpher> method_;
};
}
