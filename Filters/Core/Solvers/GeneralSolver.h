// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Solvers/MultigridSolver.h"

#include <memory>

namespace morph
{
/// Solves A X = B and A^T X = B by BiCGSTAB, with A sparse and close to an M-matrix. B has three
/// or four columns; one pass over the matrix serves all of them. The right preconditioner is a
/// multigrid of A, or of its transpose for the transposed system. An iteration is one application
/// of it. Source: van der Vorst, SIAM J. Sci. Stat. Comput. 13 (1992) 631-644.
class GeneralSolver : public MultigridSolver
{
public:
  GeneralSolver();
  ~GeneralSolver() override;
  GeneralSolver(GeneralSolver&&) noexcept;
  GeneralSolver& operator=(GeneralSolver&&) noexcept;

  void prepare(LinearEquations&& equations, Monitor& monitor) override;

  using MultigridSolver::solve;
  /// A residual of 1e-14 (|A| |x| + |b|) counts as rounding, too.
  SolveReport solve(const RightHandSide& b, MultiVector& x, double tolerance, int maxIterations,
    Monitor& monitor) const override;
  /// Solves A^T x = b. The first call makes and keeps the transposes.
  SolveReport solveTransposed(const Points& b, Points& x, double tolerance, int maxIterations,
    Monitor& monitor) const override;

private:
  struct Iteration;
  struct Transposed;
  void findNorm();

  double norm_ = 0; ///< largest row sum of |A|
  std::unique_ptr<Transposed> transposed_;
};
}
