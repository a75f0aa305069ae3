// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Solvers/CsrMatrix.h"
#include "Solvers/RowComponents.h"
#include "Solvers/SolveReport.h"
#include "Support/Monitor.h"
#include "Support/Types.h"

#include <memory>

namespace morph
{
/// Solves A X = B and A^T X = B, A sparse and close to an M-matrix, B with three columns at once:
/// BiCGSTAB (van der Vorst, SIAM J. Sci. Stat. Comput. 13 (1992) 631-644) in which one pass over
/// the matrix serves the three columns, preconditioned from the right by a smoothed-aggregation
/// multigrid of A itself, and of its transpose for the transposed system.
///
/// Where that stagnates or breaks down, restarted GMRES (Saad and Schultz, SIAM J. Sci. Stat.
/// Comput. 7 (1986) 856-869) takes over, preconditioned by an incomplete factorisation, which
/// exists for every M-matrix (Meijerink and van der Vorst, Math. Comp. 31 (1977) 148-162). It is
/// slower and partly sequential; a warning tells of it.
class GeneralSolver
{
public:
  GeneralSolver();
  ~GeneralSolver();
  GeneralSolver(GeneralSolver&&) noexcept;
  GeneralSolver& operator=(GeneralSolver&&) noexcept;

  struct Report : SolveReport
  {
    int fallBackIterations = 0; ///< of GMRES, among `iterations`
  };

  /// Takes the matrix over and leaves an empty one. `coordinates`: #rows x 3, the nodes' positions:
  /// the multigrid groups near neighbors. Throws SingularRows where a diagonal entry is not
  /// positive.
  void prepare(CsrMatrix& matrix, const ConstPoints& coordinates, Monitor& monitor);

  /// `x`: the first guess in, the solution out (#rows x 3). The guess is used where its residual is
  /// not larger than that of 0, see keepBetterGuess(). Each column stops at |b - A x| <=
  /// max(tolerance |b_column|, 1e-14 |b_all|); where rounding keeps the residual above that, at
  /// 1e-14 (|A| |x| + |b|), the best x is returned and the residual reported. An iteration counts
  /// one application of the preconditioner. Throws Error of kind NoConvergence, with the residual
  /// reached, after `maxIterations` or where the numbers overflow.
  Report solve(
    const Points& b, Points& x, double tolerance, int maxIterations, Monitor& monitor) const;

  /// The same for A^T. The first call makes the transposes, 0.4 kB a row of a hexahedral mesh, and
  /// keeps them.
  Report solveTransposed(
    const Points& b, Points& x, double tolerance, int maxIterations, Monitor& monitor) const;

  const CsrMatrix& matrix() const;
  const RowComponents& components() const;
  /// Bytes kept: matrix, hierarchy, work vectors, and the transposes where they have been made.
  std::size_t memory() const;

private:
  struct System;
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};
}
