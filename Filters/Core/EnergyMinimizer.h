// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BlockMatrix.h"
#include "MeshEnergy.h"

namespace morph
{
/// Minimises a mesh's foldover-free energy by Newton's method. The stages follow Garanzha et al. (2021, 2024).
class EnergyMinimizer
{
public:
  struct Effort
  {
    Index newtonSteps = 0;
    Index linearIterations = 0;
    Index evaluations = 0;
  };

  /// `free`: ids of the nodes to move. Keeps references.
  EnergyMinimizer(const MeshEnergy& energy, const std::vector<Index>& free)
    : energy_(energy)
    , free_(free)
  {
  }

  /// Lowers the regularisation step by step until no tetrahedron is inverted and the energy has settled. `points`: #nodes x 3, the
  /// start in, the result out. Returns whether all tetrahedra are positive.
  bool untangle(Points& points, const TargetShapes& targets, Monitor& monitor);
  /// From a valid mesh to a better one, `mostSteps` Newton steps at the most; the mesh stays valid.
  void improve(Points& points, const TargetShapes& targets, int mostSteps, Monitor& monitor);
  /// From a valid mesh to one with a lower greatest distortion.
  void stiffen(Points& points, const TargetShapes& targets, Monitor& monitor);

  const Effort& effort() const { return this->effort_; }

private:
  MeshEnergy::State minimise(Points& points, const TargetShapes& targets, const FoldoverDensity& density,
    int mostSteps, Monitor& monitor);
  MeshEnergy::State evaluate(const Points& points, const TargetShapes& targets, const FoldoverDensity& density,
    Monitor& monitor);

  const MeshEnergy& energy_;
  const std::vector<Index>& free_;
  BlockMatrix hessian_;
  Effort effort_;
};
}
