// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Solvers/ConjugateGradients.h"
#include "Solvers/LinearSolver.h"
#include "Solvers/MultiVector.h"
#include "Solvers/Multigrid.h"
#include "Solvers/RowComponents.h"

#include <cstddef>
#include <memory>
#include <mutex>

namespace morph
{
/// What the solvers of one process share: the matrix, its components, and a multigrid
/// preconditioner. Each component is a system of its own: it stops at its own norms, so that a body
/// that hardly moves is as exact, in its own size, as one that moves far.
class MultigridSolver : public LinearSolver
{
public:
  /// `x`: what it is after an error has no meaning. Each column of each component stops at
  /// |b - A x| <= max(tolerance |b_column|, 1e-14 |b_all|); the second term ends columns that are
  /// pure rounding. A guess with a larger residual than 0 is dropped. If rounding keeps the
  /// residual above the goal, the best x is returned and the residual reported. Throws Error of
  /// kind NoConvergence, with the residual, after `maxIterations` or on overflow.
  SolveReport solve(const RightHandSide& b, MultiVector& x, double tolerance, int maxIterations,
    Monitor& monitor) const override = 0;
  using LinearSolver::solve;

  void prepare(LinearEquations&& equations, Monitor& monitor) override;
  void product(const Points& from, Points& to, Monitor& monitor) const override;
  void precondition(const Points& from, Points& to, Monitor& monitor) const override;

  const CsrMatrix& matrix() const override { return this->parts_->A; }
  const RowComponents& components() const override { return this->parts_->components; }

protected:
  explicit MultigridSolver(Multigrid::Symmetry symmetry)
    : symmetry_(symmetry)
  {
  }

  /// The vectors of one solve. Floats are in units of `unscale`, in which the first residual has
  /// Multigrid::Size. The iterate moves along directions as rounded, so that rounding them costs no
  /// accuracy.
  struct Workspace
  {
    Workspace(Index rows, const Multigrid& multigrid)
      : residual(rows)
      , image(rows)
      , residual32(rows)
      , step(rows)
      , direction(rows)
      , multigrid(multigrid.workspace())
    {
    }

    MultiVector residual, image;
    FloatMultiVector residual32, step, direction;
    Multigrid::Workspace multigrid;
  };
  /// In their own place, as the hierarchy refers to the matrix.
  struct Parts
  {
    CsrMatrix A;
    RowComponents components;
    Multigrid multigrid;
    mutable std::mutex mutex; ///< of `spare`
    mutable std::unique_ptr<Workspace> spare;

    /// The vectors of the last solve, or others while it runs. New memory would cost as much as
    /// the iterations of a solve where pages are dear, as in virtual machines.
    std::shared_ptr<Workspace> workspace() const;
    /// Sets r to b - A x; returns the squared norms.
    Sums residual(
      const RightHandSide& b, const MultiVector& x, MultiVector& r, Monitor& monitor) const;
    /// Returns the units of floats for residuals of these norms; 0 where none is wanted.
    Sums unscale(const Sums& norm2, const SumsMask& wanted) const;
  };
  std::unique_ptr<Parts> parts_;

private:
  Multigrid::Symmetry symmetry_;
};

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
