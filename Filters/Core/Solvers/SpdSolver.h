// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Solvers/MultigridSolver.h"

namespace morph
{
/// Solves A X = B by conjugate gradients, with A sparse, symmetric positive definite. B has three
/// or four columns; one pass over the matrix serves all of them.
class SpdSolver : public MultigridSolver
{
public:
  SpdSolver()
    : MultigridSolver(Multigrid::Symmetry::Symmetric)
  {
  }

  using MultigridSolver::solve;
  SolveReport solve(const RightHandSide& b, MultiVector& x, double tolerance, int maxIterations,
    Monitor& monitor) const override;

private:
  struct Iteration;
};
}
