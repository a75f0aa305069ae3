// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Solvers/ConjugateGradients.h"
#include "Solvers/CsrMatrix.h"
#include "Solvers/MultiVector.h"
#include "Solvers/RowComponents.h"
#include "Support/Communicator.h"
#include "Support/Monitor.h"
#include "Support/Types.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// The rows of a sparse matrix A on one process, or on one of several.
struct LinearEquations
{
  CsrMatrix matrix;      ///< #rows x #rows: the columns of this process's unknowns
  Points coordinates;    ///< #rows x 3: positions of the nodes, near which are near in the graph
  CsrMatrix ghosts = {}; ///< #rows x #ghosts: other processes' unknowns
  std::vector<std::int64_t> ghostNumbers = {}; ///< #ghosts: their numbers among all unknowns
  RowComponents components = {}; ///< of several processes: those of all unknowns, of these rows

  /// The rows whose diagonal entry is not positive and finite.
  std::vector<Index> singularRows() const;
};

/// Solves A X = B for up to four columns at once. On several processes all functions are
/// collective.
class LinearSolver
{
public:
  virtual ~LinearSolver() = default;

  /// Takes over the equations. Throws SingularRows, with those of this process, if a diagonal entry
  /// is not positive.
  virtual void prepare(LinearEquations&& equations, Monitor& monitor) = 0;
  /// Solves A x = b, each component to its own size. `x`: #rows, the first guess, then the
  /// solution.
  virtual SolveReport solve(const RightHandSide& b, MultiVector& x, double tolerance,
    int maxIterations, Monitor& monitor) const = 0;
  /// The same for three columns, #rows x 3.
  SolveReport solve(
    const Points& b, Points& x, double tolerance, int maxIterations, Monitor& monitor) const;
  /// Solves A^T x = b; as solve() unless A is not symmetric.
  virtual SolveReport solveTransposed(
    const Points& b, Points& x, double tolerance, int maxIterations, Monitor& monitor) const
  {
    return this->solve(b, x, tolerance, maxIterations, monitor);
  }
  /// Sets `to` to A `from`, #rows x 3.
  virtual void product(const Points& from, Points& to, Monitor& monitor) const = 0;
  /// Sets `to` to B `from`, #rows x 3, with a fixed B near A^-1. It is symmetric and positive
  /// definite where A is.
  virtual void precondition(const Points& from, Points& to, Monitor& monitor) const = 0;

  /// A without the columns of ghosts; empty if the solver has it in another form.
  virtual const CsrMatrix& matrix() const = 0;
  virtual const RowComponents& components() const = 0;
};

/// Rows of a system whose three columns are the coordinates of nodes, and the directions in which
/// these may change. All other rows are free.
struct RowConstraints
{
  std::vector<int> rows;                   ///< distinct
  std::vector<Eigen::Matrix3d> directions; ///< of each: an orthogonal projection, symmetric
};

/// Solves P A x = P b for the x that differ from the guess by vectors of P's range, where P
/// projects the constrained rows onto their directions. The columns are coupled there, so all
/// three are iterated as one. Stops at |P (b - A x)| <= tolerance max(|b|, |A guess|), norms over
/// all rows. A is symmetric and positive definite. The preconditioner knows no constraints:
/// iterations grow with the square root of the number of cells across the mesh. `work`: of any
/// content, perhaps from the last call. Throws Error of kind NoConvergence.
SolveReport solveConstrained(const LinearSolver& solver, const Points& b,
  const RowConstraints& constraints, Points& x, double tolerance, int maxIterations,
  PointsVectors& work, Monitor& monitor, const Communicator& communicator = Communicator::alone());
}
