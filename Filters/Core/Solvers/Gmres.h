// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Solvers/IncompleteLU.h"
#include "Solvers/MultiVector.h"
#include "Support/Monitor.h"

namespace morph
{
/// GMRES (Saad and Schultz, SIAM J. Sci. Stat. Comput. 7 (1986) 856-869) for three right-hand sides
/// at once, each with its own Krylov space, preconditioned from the right by an incomplete
/// factorisation. What GeneralSolver falls back on: it cannot break down, and its residual never
/// grows. Memory: up to 1 kB a row while it runs.
class Gmres
{
public:
  /// `matrix` must outlive this object.
  explicit Gmres(const CsrMatrix& matrix);

  /// Up to 30 iterations, fewer where every column reaches its goal. `residual`: b - A x, `norm2`
  /// and `goal2`: squared norms per column. Adds to `solution`. Returns the iterations made, at
  /// least 1.
  int run(const MultiVector& residual, const MultiVectorRow& norm2, const MultiVectorRow& goal2,
    MultiVector& solution, Monitor& monitor);

private:
  const CsrMatrix* matrix_;
  IncompleteLU preconditioner_;
  std::vector<MultiVector> basis_;
};
}
