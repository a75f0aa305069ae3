// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/DistributedMesh.h"
#include "Distributed/HypreSolver.h"

#include "LinearMethods/DirichletSystem.h"
#include "Morpher/CellStiffness.h"
#include "Morpher/Morpher.h"
#include "Solvers/CsrMatrix.h"

#include <memory>
#include <utility>
#include <vector>

namespace morph::distributed
{
/// A method that solves A_I U_I = -A_B U_B with the rows of each rank's own free nodes. Its
/// processes are a RankCommunicator.
class SystemMethod : public LinearMorpher
{
public:
  /// Sets the relative residual at which the solver stops, per coordinate. Range (0, 1), default
  /// 1e-10.
  void setTolerance(double tolerance);
  const HypreSolver& solver() const { return *this->solver_; }
  /// Of FEMWARP; see morph::StiffMorpher. The values are those of the cells of this rank's piece.
  void setStiffness(CellStiffness stiffness) { this->stiffness_ = std::move(stiffness); }
  const CellStiffness& stiffness() const { return this->stiffness_; }

protected:
  explicit SystemMethod(HypreSolver::Kind kind)
    : kind_(kind)
  {
  }

  struct Rows
  {
    CsrMatrix interior; ///< #free x #free
    CsrMatrix coupling; ///< #free x #columns
  };
  /// Assembles the rows of free nodes. `columns`: the local nodes of the other columns. `factors`:
  /// of the cells, see stiffnessFactors(). Communicates where it has to, and throws on all ranks.
  virtual Rows assemble(
    const std::vector<Index>& columns, const std::vector<double>& factors, Monitor& monitor) = 0;
  /// The method's own counts, of the whole mesh.
  virtual std::vector<Statistic> counts() const { return {}; }

  const CsrMatrix& coupling() const { return this->coupling_; } ///< #free x #prescribed

  void doPrepare(const Mesh& rest, Monitor& monitor) final;
  EvaluateReport displace(const Points& prescribed, Points& free, Monitor& monitor) const final;
  EvaluateReport displaceTranspose(
    const Points& free, Points& prescribed, Monitor& monitor) const final;

private:
  /// Solves each body to its own size, in which it is given to the solver, whose norms are over all
  /// rows. `x`: the first guess, then the solution.
  SolveReport solveEach(const HypreSolver& solver, Points rhs, Points& x, Monitor& monitor) const;
  EvaluateReport report(const SolveReport& solved, Monitor& monitor) const;

  HypreSolver::Kind kind_;
  double tolerance_ = 1e-10;
  CellStiffness stiffness_;
  bool isUniform_ = true;
  CsrMatrix coupling_; ///< #free x #prescribed
  AffineGuess guess_;
  double affineResidual_ = 0;
  std::unique_ptr<HypreSolver> solver_;
  mutable std::unique_ptr<HypreSolver> transposed_; ///< of a General solver, once it is asked for
};

/// FEMWARP; see morph::FemWarp.
class FemWarp : public SystemMethod
{
public:
  FemWarp()
    : SystemMethod(HypreSolver::Kind::Symmetric)
  {
  }
  void takeEvaluateOptions(const Morpher& serial) override;

protected:
  Rows assemble(const std::vector<Index>& columns, const std::vector<double>& factors,
    Monitor& monitor) override;
};

/// LBWARP; see morph::LogBarrierWarp.
class LogBarrierWarp : public SystemMethod
{
public:
  /// `relax`: free nodes outside the hull of their neighbors take fall-backs; otherwise they are an
  /// error.
  explicit LogBarrierWarp(bool relax)
    : SystemMethod(HypreSolver::Kind::General)
    , relax_(relax)
  {
  }
  void takeEvaluateOptions(const Morpher& serial) override;
  /// The second ring of a node's neighbors is a fall-back.
  int layers() const override { return 2; }

protected:
  Rows assemble(const std::vector<Index>& columns, const std::vector<double>& factors,
    Monitor& monitor) override;
  std::vector<Statistic> counts() const override { return this->counts_; }

private:
  bool relax_;
  std::vector<Statistic> counts_;
};
}
