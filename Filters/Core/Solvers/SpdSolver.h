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
/// Solves A X = B, A symmetric positive definite and sparse, B with three columns at once:
/// preconditioned conjugate gradients in which one pass over the matrix serves the three columns,
/// with a smoothed-aggregation multigrid preconditioner (Vanek, Mandel, Brezina, Computing 56
/// (1996) 179-196).
class SpdSolver
{
public:
  SpdSolver();
  ~SpdSolver();
  SpdSolver(SpdSolver&&) noexcept;
  SpdSolver& operator=(SpdSolver&&) noexcept;

  /// Takes the matrix over and leaves an empty one. `coordinates`: #rows x 3, the nodes' positions:
  /// the multigrid groups near neighbors. Throws SingularRows where a diagonal entry is not
  /// positive.
  void prepare(CsrMatrix& matrix, const ConstPoints& coordinates, Monitor& monitor);

  /// `x`: the first guess in, the solution out (#rows x 3). The guess is used where its residual is
  /// not larger than that of 0, see keepBetterGuess(). Each column stops at |b - A x| <=
  /// max(tolerance |b_column|, 1e-14 |b_all|): the second term ends columns that are pure roundoff.
  /// The norms are over all rows. Where rounding keeps the residual above that, the best x is
  /// returned and the residual reported. Throws Error of kind NoConvergence, with the residual
  /// reached, after `maxIterations` or where the numbers overflow.
  SolveReport solve(
    const Points& b, Points& x, double tolerance, int maxIterations, Monitor& monitor) const;

  const CsrMatrix& matrix() const;
  const RowComponents& components() const;
  /// Bytes that prepare() keeps: matrix, hierarchy, work vectors.
  std::size_t memory() const;

private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};
}
