// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Solvers/MultiVector.h"
#include "Solvers/RightHandSide.h"
#include "Support/Monitor.h"

#include <memory>

namespace morph
{
/// Restarted GMRES (Saad and Schultz, SIAM J. Sci. Stat. Comput. 7 (1986) 856-869), preconditioned
/// from the right by an incomplete factorisation with thresholds (Saad, Numer. Linear Algebra
/// Appl. 1 (1994) 387-402). Eigen's, column by column; sequential. GeneralSolver falls back on it:
/// unlike BiCGSTAB it does not break down. Memory while it runs: three times that of the matrix,
/// 250 bytes a row, and the matrix, which GeneralSolver copies for it.
class Gmres
{
public:
  /// Makes the factorisation. `matrix` must outlive this object.
  explicit Gmres(const CsrMatrix& matrix);
  ~Gmres();

  /// Makes up to 30 iterations for each column above its goal. `norm2` and `goal2`: squared norms
  /// per column, of the residual b - A x and of what it should be; `x`: the guess in, the solution
  /// out. Returns the most iterations made for a column, at least 1.
  int run(const RightHandSide& b, const MultiVectorRow& norm2, const MultiVectorRow& goal2,
    MultiVector& x, Monitor& monitor);

private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};
}
