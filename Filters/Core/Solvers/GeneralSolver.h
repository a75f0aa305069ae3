// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Solvers/MultiVector.h"
#include "Solvers/RightHandSide.h"
#include "Solvers/RowComponents.h"
#include "Solvers/SolveReport.h"
#include "Support/Monitor.h"
#include "Support/Types.h"

#include <memory>

namespace morph
{
class MixedPrecisionMatrix;

/// Solves A X = B and A^T X = B by BiCGSTAB, with A sparse and close to an M-matrix. B has three
/// or four columns; one pass over the matrix serves all of them. The right preconditioner is a
/// smoothed-aggregation multigrid of A, or of its transpose for the transposed system. Source: van
/// der Vorst, SIAM J. Sci. Stat. Comput. 13 (1992) 631-644.
///
/// Where that stagnates or breaks down, restarted GMRES with an incomplete factorisation takes over
/// (Gmres.h). It is slower and sequential; a warning tells of it.
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

  /// Takes over `matrix`, whose columns are not narrow yet. `coordinates`: #rows x 3, positions of
  /// the nodes, as the multigrid groups near neighbors. Throws SingularRows if a diagonal entry is
  /// not positive.
  void prepare(MixedPrecisionMatrix matrix, const ConstPoints& coordinates, Monitor& monitor);

  /// Solves A x = b. `x`: #rows x 3, the first guess, then the solution. A guess with a larger
  /// residual than 0 is not used, see keepBetterGuess(). Each column stops at |b - A x| <=
  /// max(tolerance |b_column|, 1e-14 |b_all|). If rounding keeps the residual above this, at 1e-14
  /// (|A| |x| + |b|), the best x is returned and the residual reported. An iteration is one
  /// application of the preconditioner. Throws Error of kind NoConvergence, with the residual,
  /// after `maxIterations` or on overflow.
  ///@{
  Report solve(
    const Points& b, Points& x, double tolerance, int maxIterations, Monitor& monitor) const;
  /// The same for up to four columns, without copies; what `x` is after an error has no meaning.
  Report solve(const RightHandSide& b, MultiVector& x, double tolerance, int maxIterations,
    Monitor& monitor) const;
  ///@}

  /// Solves A^T x = b. The first call makes and keeps the transposes, 0.4 kB a row of a hexahedral
  /// mesh.
  Report solveTransposed(
    const Points& b, Points& x, double tolerance, int maxIterations, Monitor& monitor) const;

  const MixedPrecisionMatrix& matrix() const;
  const RowComponents& components() const;
  /// Returns the bytes in use: matrix, hierarchy, work vectors, and the transposes if made.
  std::size_t memory() const;

private:
  struct System;
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};
}
