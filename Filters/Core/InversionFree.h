// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "FemWarp.h"
#include "FoldoverStages.h"
#include "MeshEnergy.h"
#include "Morpher.h"
#include "TargetShapes.h"

#include <memory>

namespace morph
{
/// The inversion-free morph: FEMWARP's mesh, or the mesh at rest with its boundary moved, is the start of a minimisation that drives
/// inverted cells out and then improves the worst ones. The energy is that of Garanzha et al. (ACM Trans. Graph. 40(4) (2021) 154) on
/// the averaged simplicial decompositions of all cells, so a positive minimum is the scaled Jacobian's corner test.
/// Hexahedra, wedges and pyramids aim for their shape at rest, stretched to FEMWARP's edge lengths; tetrahedra for their shape at
/// rest. Newton's method with the projected Hessian; once valid, stiffening (ACM Trans. Graph. 43(1) (2024) 10) lowers the worst
/// distortion. Where FEMWARP's mesh is valid and its least scaled Jacobian higher, that is the result: never worse.
///
/// A cell with a tetrahedron whose four nodes are all prescribed and which is not positive is out of reach of any method:
/// it is named, and the rest of the mesh is morphed.
///
/// Counts: `NewtonSteps`, `LinearIterations`, `EnergyEvaluations`, `InfeasibleCells`, `KeptFEMWARP` (1 or 0).
///
/// prepare(): FEMWARP's, and passes over the cells. evaluate(): 5 to 60 Newton steps of some 3 microseconds a tetrahedron (ten a
/// hexahedron) each and a linear solution; 2.5 kB a hexahedron meanwhile. Not linear in the boundary: no adjoint.
class InversionFree : public Morpher
{
public:
  enum class Start
  {
    FemWarp,
    Rest
  };
  /// Before evaluate(). A mesh that is inverted at rest always starts from rest. Default FemWarp.
  void setStart(Start start) { this->start_ = start; }
  /// What cells other than tetrahedra aim for. Before evaluate(). Default Stretched.
  void setTarget(Target target) { this->target_ = target; }
  /// Of FEMWARP, and of the energy's relative decrease at which a stage ends. Range (0, 1), default 1e-10 and 1e-5.
  void setTolerance(double tolerance) { this->femWarp_.setTolerance(tolerance); }
  /// Default Newton.
  void setMinimizer(FoldoverStages::Minimizer minimizer) { this->minimizer_ = minimizer; }
  /// Whether to lower the worst distortion in the end. Default on.
  void setStiffening(bool on) { this->stiffening_ = on; }
  /// How often the targets are taken anew from the mesh as it has become. Default 2.
  void setRefreshes(int refreshes) { this->refreshes_ = refreshes; }

protected:
  void doPrepare(const Mesh& rest, Monitor& monitor) override;
  EvaluateReport displace(const Points& prescribed, Points& free, Monitor& monitor) const override;

private:
  /// FEMWARP's mesh, times scale_.
  Points warped(const Points& prescribed, EvaluateReport& report, Monitor& monitor) const;
  void minimize(MeshEnergy& energy, FoldoverStages& stages, Points& points, Monitor& monitor) const;
  double leastScaledJacobian(const Points& points, Monitor& monitor) const;

  Start start_ = Start::FemWarp;
  Target target_ = Target::Stretched;
  FoldoverStages::Minimizer minimizer_ = FoldoverStages::Minimizer::Newton;
  bool stiffening_ = true;
  int refreshes_ = 2;

  Mesh mesh_; ///< at rest, its coordinates times scale_
  double scale_ = 1;
  std::vector<std::int8_t> orientation_;
  bool validAtRest_ = true;
  FemWarp femWarp_;
};
}
