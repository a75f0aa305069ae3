// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Solvers/MultiVector.h"
#include "Solvers/RightHandSide.h"
#include "Solvers/RowComponents.h"
#include "Solvers/SolveReport.h"
#include "Support/Monitor.h"
#include "Support/Types.h"

#include <Eigen/Core>

#include <memory>
#include <vector>

namespace morph
{
class MixedPrecisionMatrix;

/// Rows of a system whose three columns are the coordinates of nodes, and the directions in which
/// these may change. All other rows are free.
struct RowConstraints
{
  std::vector<int> rows;                   ///< distinct
  std::vector<Eigen::Matrix3d> directions; ///< of each: an orthogonal projection, symmetric
};

/// Solves A X = B by conjugate gradients, with A sparse, symmetric positive definite. B has three
/// or four columns; one pass over the matrix serves all of them. The preconditioner is a
/// smoothed-aggregation multigrid (Vanek, Mandel, Brezina, Computing 56 (1996) 179-196).
class SpdSolver
{
public:
  SpdSolver();
  ~SpdSolver();
  SpdSolver(SpdSolver&&) noexcept;
  SpdSolver& operator=(SpdSolver&&) noexcept;

  /// Takes over `matrix`, whose columns are not narrow yet. `coordinates`: #rows x 3, positions of
  /// the nodes, as the multigrid groups near neighbors. Throws SingularRows if a diagonal entry is
  /// not positive.
  void prepare(MixedPrecisionMatrix matrix, const ConstPoints& coordinates, Monitor& monitor);

  /// Solves A x = b. `x`: #rows x 3, the first guess, then the solution. A guess with a larger
  /// residual than 0 is not used, see keepBetterGuess(). Each column stops at |b - A x| <=
  /// max(tolerance |b_column|, 1e-14 |b_all|); the second term ends columns that are pure rounding.
  /// Norms are over all rows. If rounding keeps the residual above this, the best x is returned and
  /// the residual reported. Throws Error of kind NoConvergence, with the residual, after
  /// `maxIterations` or on overflow.
  ///@{
  SolveReport solve(
    const Points& b, Points& x, double tolerance, int maxIterations, Monitor& monitor) const;
  /// The same for up to four columns, without copies; what `x` is after an error has no meaning.
  SolveReport solve(const RightHandSide& b, MultiVector& x, double tolerance, int maxIterations,
    Monitor& monitor) const;
  ///@}

  /// Solves P A x = P b for the x that differ from the guess by vectors of P's range, where P
  /// projects the constrained rows onto their directions. The columns are coupled there, so all
  /// three are iterated as one. Stops at |P (b - A x)| <= tolerance max(|b|, |A guess|). Otherwise
  /// as solve(). The preconditioner knows no constraints: iterations grow with the square root of
  /// the number of cells across the mesh.
  SolveReport solveConstrained(const Points& b, const RowConstraints& constraints, Points& x,
    double tolerance, int maxIterations, Monitor& monitor) const;
  /// Computes `to` = B `from`, #rows x 3, with the multigrid cycle B. It is symmetric and positive
  /// definite, and near A^-1; single precision.
  void precondition(const Points& from, Points& to, Monitor& monitor) const;
  /// Returns A x, #rows x 3.
  Points product(const Points& x, Monitor& monitor) const;

  /// Returns the matrix's diagonal.
  Eigen::VectorXd diagonal(Monitor& monitor) const;

  const MixedPrecisionMatrix& matrix() const;
  const RowComponents& components() const;
  /// Returns the bytes of matrix, hierarchy and the work vectors of one solve.
  std::size_t memory() const;

private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};
}
