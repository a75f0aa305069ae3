// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LinearMethods/DirichletSystem.h"
#include "Morpher/Morpher.h"
#include "Solvers/GeneralSolver.h"

#include <vector>

namespace morph
{
/// LBWARP: (I - W_I) U_I = W_B U_B, where every free node is a convex combination of its neighbors.
/// Neighbors share a volume cell with the node. A log barrier determines the weights on the
/// undeformed mesh; the moved mesh keeps them. Sources: Shontz and Vavasis, IMR 2003, 147-158;
/// Staten et al., IMR 2011, equation (13).
///
/// The matrix is an M-matrix, so every free node stays in the convex hull of the prescribed ones.
/// Affine motions are exact to the solver's tolerance. Weights exist for a node strictly inside the
/// hull of its neighbors, whatever its cells are like. For a node on a face of the hull they exist
/// as a limit (see LogBarrierWeights.h).
///
/// prepare(): one pass over the nodes; keeps about 0.5 kB a node of a hexahedral mesh. evaluate():
/// 6 to 20 applications of the preconditioner to 1e-10, nearly independent of the mesh's size.
/// applyTranspose(): as evaluate(); the first call also makes the transposed system, 0.4 kB a node.
class LogBarrierWarp : public LinearMorpher
{
public:
  /// The treatment of a node outside its neighbors' hull, at an inverted or strongly concave place
  /// of the undeformed mesh.
  enum class OutsideHull
  {
    /// prepare() throws Error with their number and the first ids.
    Error,
    /// The node takes the first of these that exists: log-barrier weights among its neighbors and
    /// theirs; affine weights of minimum norm; FEMWARP's row of the matrix. Affine weights keep
    /// affine motions exact, but may be negative, so the node is not bounded.
    Relax
  };

  /// Sets the relative residual at which the solver stops, per coordinate. Range (0, 1), default
  /// 1e-10.
  void setTolerance(double tolerance);
  double tolerance() const override { return this->tolerance_; }
  void takeEvaluateOptions(const Morpher& other) override
  {
    this->tolerance_ = static_cast<const LogBarrierWarp&>(other).tolerance_;
  }

  /// Call it before prepare(). Default Error.
  void setOutsideHull(OutsideHull outsideHull) { this->outsideHull_ = outsideHull; }
  OutsideHull outsideHull() const { return this->outsideHull_; }

  /// Returns the node id of each matrix row: NodePartition::free, or these ids in a better order
  /// for memory.
  const std::vector<Index>& rows() const
  {
    return this->rows_.empty() ? this->partition().free : this->rows_;
  }
  /// Returns the solver with its matrix I - W_I (#free x #free, in the order of rows()), for
  /// benchmarks and checks.
  const GeneralSolver& solver() const { return this->solver_; }
  /// Returns -W_B, #free x #prescribed; rows as above, columns in the order of
  /// NodePartition::prescribed.
  const CsrMatrix& coupling() const { return this->coupling_; }
  /// Newton steps for the weights: the mean and the maximum over the nodes.
  double meanWeightIterations() const { return this->meanWeightIterations_; }
  int mostWeightIterations() const { return this->mostWeightIterations_; }

protected:
  void doPrepare(const Mesh& rest, Monitor& monitor) override;
  bool hasPrepareOptionsOf(const Morpher& other) const override
  {
    return this->outsideHull_ == static_cast<const LogBarrierWarp&>(other).outsideHull_;
  }
  /// The report counts OutsideHullNodes, and the TwoRingNodes, AffineNodes and StiffnessNodes among
  /// them.
  EvaluateReport displace(const Points& prescribed, Points& free, Monitor& monitor) const override;
  EvaluateReport displaceFields(
    const FourFields& prescribed, FourFields& free, Monitor& monitor) const override;
  EvaluateReport displaceTranspose(
    const Points& free, Points& prescribed, Monitor& monitor) const override;

private:
  /// Sets `x` to the displacements of the rows.
  EvaluateReport solve(const MultiVector& prescribed, MultiVector& x, Monitor& monitor) const;
  EvaluateReport report(const SolveReport& solved, Monitor& monitor) const;

  double tolerance_ = 1e-10;
  OutsideHull outsideHull_ = OutsideHull::Error;
  std::vector<Index> rows_; ///< empty where they are the free nodes
  GeneralSolver solver_;
  CsrMatrix coupling_;
  AffineGuess guess_;
  AffineResidual affineResidual_;
  double meanWeightIterations_ = 0;
  int mostWeightIterations_ = 0;
  std::vector<Statistic> outsideCounts_;
};
}
