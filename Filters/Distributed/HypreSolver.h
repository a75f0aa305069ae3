// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/Ranks.h"

#include "Solvers/LinearSolver.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace morph::distributed
{
/// Solves A X = B with rows distributed over ranks, by hypre: conjugate gradients for a symmetric
/// positive definite matrix, BiCGSTAB for any other, both preconditioned by one V-cycle of
/// BoomerAMG. Source: Henson and Yang, Applied Numerical Mathematics 41 (2002) 155-177.
class HypreSolver : public LinearSolver
{
public:
  enum class Kind
  {
    Symmetric, ///< and positive definite
    General
  };

  /// `ranks` must outlive this object.
  HypreSolver(const Ranks& ranks, Kind kind);
  ~HypreSolver() override;

  /// Sets up the preconditioner. The rows of all ranks are numbered rank by rank. Throws Error on
  /// all ranks where there are more unknowns than hypre's integers hold.
  void prepare(LinearEquations&& equations, Monitor& monitor) override;
  /// Each column's residual is then below `tolerance` times |b| (Euclidean norms), where hypre gets
  /// b in units of each component's size. Throws Error on all ranks where `maxIterations` are too
  /// few. A right-hand side of zeros gives zeros.
  SolveReport solve(const RightHandSide& b, MultiVector& x, double tolerance, int maxIterations,
    Monitor& monitor) const override;
  using LinearSolver::solve;
  /// The first call makes and keeps a solver of the transposed matrix. Cost: messages of the
  /// entries in other ranks' columns, and prepare().
  SolveReport solveTransposed(const Points& b, Points& x, double tolerance, int maxIterations,
    Monitor& monitor) const override;
  void product(const Points& from, Points& to, Monitor& monitor) const override;
  /// One V-cycle for each column.
  void precondition(const Points& from, Points& to, Monitor& monitor) const override;

  /// Empty: hypre has the matrix.
  const CsrMatrix& matrix() const override { return this->none_; }
  const RowComponents& components() const override { return this->components_; }

  /// The number of unknowns that hypre's integers can number.
  static std::int64_t mostUnknowns();
  /// Returns the sum of `rows` over the ranks. Throws Error on all of them where that is more than
  /// mostUnknowns(). Collective.
  static std::int64_t countUnknowns(const Ranks& ranks, std::int64_t rows);
  /// The number of unknowns of all ranks.
  std::int64_t unknowns() const { return this->unknowns_; }

private:
  struct Handles;
  void begin(std::int64_t rows);
  void end();
  std::unique_ptr<HypreSolver> makeTransposed() const;
  /// Calls action(column, result), vectors of hypre, for each column.
  template <typename Action>
  void byColumns(const Points& columns, Points& results, const Action& action) const;

  const Ranks& ranks_;
  Kind kind_;
  std::unique_ptr<Handles> handles_;
  CsrMatrix none_;
  RowComponents components_;
  mutable std::unique_ptr<HypreSolver> transposed_;
  std::int64_t rows_ = 0, first_ = 0, unknowns_ = 0;
};
}
