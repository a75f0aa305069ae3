// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Energies/MeshEnergy.h"
#include "Optimization/Minimizers.h"

namespace morph
{
/// The stages by which a mesh's foldover-free energy is minimised (Garanzha et al., ACM Trans.
/// Graph. 40(4) (2021), arXiv 2102.03069 and 43(1) (2024) 10). `points` in all: #nodes x 3, the
/// start in, the result out.
class FoldoverContinuation
{
public:
  enum class Minimizer
  {
    Newton,
    LimitedMemoryBfgs ///< as fast on some 10,000 cells, slower on many; without a matrix
  };

  FoldoverContinuation(MeshEnergy& energy, Minimizer minimizer)
    : energy_(energy)
    , minimizer_(minimizer)
  {
  }

  /// Lowers the regularisation stage by stage, of which there are at most `stages`, until no
  /// tetrahedron is inverted and the energy has settled. Gives up once ten stages in a row have
  /// neither left fewer tetrahedra inverted nor raised the least determinant by 5 % of itself:
  /// where the boundary admits no valid mesh that ends it soon. Returns whether all tetrahedra are
  /// positive.
  bool untangle(Points& points, Monitor& monitor, int stages = 60);
  /// From a valid mesh to a better one by at most so many steps of the minimiser; the mesh stays
  /// valid.
  void improve(Points& points, int steps, Monitor& monitor);
  /// From a valid mesh to one with a lower greatest distortion; the mesh stays valid.
  void stiffen(Points& points, Monitor& monitor);

  Minimizer minimizer() const { return this->minimizer_; }
  const MinimizerEffort& effort() const { return this->effort_; }
  /// Counts the effort of stages on a part of the mesh as well.
  void include(const MinimizerEffort& effort);

private:
  void setDensity(double epsilon, double stiffness = 0);
  MeshEnergy::State evaluate(const Points& points, Monitor& monitor);
  MeshEnergy::State minimize(Points& points, int steps, Monitor& monitor);

  MeshEnergy& energy_;
  Minimizer minimizer_;
  BlockCsr3f matrix_;
  MinimizerEffort effort_;
};
}
