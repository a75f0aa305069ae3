// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LinearMethods/DirichletSystem.h"
#include "Morpher/Morpher.h"
#include "Solvers/GeneralSolver.h"

#include <vector>

namespace morph
{
/// LBWARP: every free node is a convex combination of its neighbors, the nodes that share a volume
/// cell with it, with the weights that a log barrier finds on the undeformed mesh; the same
/// combinations hold on the moved mesh (Shontz and Vavasis, IMR 2003, 147-158; Staten et al., IMR
/// 2011, equation (13)): (I - W_I) U_I = W_B U_B in displacements.
///
/// The matrix is an M-matrix, so every free node stays in the convex hull of the prescribed ones.
/// Affine motions come out exactly, to the solver's tolerance. Weights exist for a node strictly
/// inside the hull of its neighbors, whatever their cells are like, and in the limit for one on a
/// face of that hull (see LogBarrierWeights.h).
///
/// prepare(): one pass over the nodes; keeps about 0.8 kB per node of a hexahedral mesh.
/// evaluate(): 6 to 20 applications of the preconditioner to 1e-10, nearly independent of the
/// mesh's size. applyTranspose(): as evaluate(); the first one also makes the transposed system,
/// 0.7 kB per node.
class LogBarrierWarp : public LinearMorpher
{
public:
  /// What becomes of a node outside its neighbors' hull, at an inverted or strongly concave place
  /// of the undeformed mesh.
  enum class OutsideHull
  {
    /// prepare() throws Error with their number and the first ids.
    Error,
    /// It takes the first of these that there are: log-barrier weights among its neighbors and
    /// theirs; least-norm affine weights, which keep affine motions exact but may be negative, so
    /// nothing bounds the node; FEMWARP's row of the matrix.
    Relax
  };

  /// Relative residual at which the solver stops, per coordinate. Range (0, 1), default 1e-10.
  void setTolerance(double tolerance);
  double tolerance() const { return this->tolerance_; }

  /// Default Error. For the next prepare().
  void setOutsideHull(OutsideHull outsideHull) { this->outsideHull_ = outsideHull; }
  OutsideHull outsideHull() const { return this->outsideHull_; }

  /// The node id of each matrix row: NodePartition::free, or those ids in a better order for the
  /// memory.
  const std::vector<Index>& rows() const { return this->rows_; }
  /// The solver with its matrix I - W_I (#free x #free, in the order of rows()), for benchmarks and
  /// checks.
  const GeneralSolver& solver() const { return this->solver_; }
  /// -W_B, #free x #prescribed; rows as above, columns in the order of NodePartition::prescribed.
  const CsrMatrix& coupling() const { return this->coupling_; }
  /// Newton steps that the weights took: the mean over the nodes, and the most.
  double meanWeightIterations() const { return this->meanWeightIterations_; }
  int mostWeightIterations() const { return this->mostWeightIterations_; }
  /// Bytes kept.
  std::size_t memory() const;

protected:
  void doPrepare(const Mesh& rest, Monitor& monitor) override;
  /// Counts in the report: OutsideHullNodes, and how many of them became TwoRingNodes, AffineNodes
  /// and StiffnessNodes; FallBackIterations, the solver's.
  EvaluateReport displace(const Points& prescribed, Points& free, Monitor& monitor) const override;
  EvaluateReport displaceTranspose(
    const Points& free, Points& prescribed, Monitor& monitor) const override;

private:
  EvaluateReport report(const GeneralSolver::Report& solved, Monitor& monitor) const;

  double tolerance_ = 1e-10;
  OutsideHull outsideHull_ = OutsideHull::Error;
  std::vector<Index> rows_;
  GeneralSolver solver_;
  CsrMatrix coupling_;
  AffineGuess guess_;
  double meanWeightIterations_ = 0;
  int mostWeightIterations_ = 0;
  std::vector<Statistic> outsideCounts_;
};
}
