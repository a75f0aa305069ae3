// SPDX-License-Identifier: BSD-3-Clause
#include "Solvers/SpdSolver.h"

#include "Solvers/ConjugateGradients.h"
#include "Solvers/RowProducts.h"

namespace morph
{
/// The vectors of conjugate gradients, see runConjugateGradients(). Each pass sums what the next
/// one needs. z and p are in units of `unscale`, which cancel in alpha and beta.
struct SpdSolver::Iteration
{
  using Row = MultiVectorRow;
  const Parts& parts;
  const RightHandSide& b;
  MultiVector& x;
  Workspace& work;
  Monitor& monitor;
  Sums unit = {}, inverse = {}; ///< of the floats

  const RowComponents& components() const { return this->parts.components; }
  Index rows() const { return this->parts.A.rows(); }

  Sums residual()
  {
    return this->parts.residual(this->b, this->x, this->work.residual, this->monitor);
  }
  void begin(const Sums& norm2, const SumsMask& running)
  {
    this->unit = this->parts.unscale(norm2, running);
    this->inverse = (this->unit > 0).select(1 / this->unit, 0);
    this->components().forRows(this->rows(), this->monitor,
      [&](Index i, int component)
      {
        this->scaleResidual(i, component);
        this->work.direction[i].setZero();
      });
  }
  void scaleResidual(Index i, int component)
  {
    this->work.residual32[i] =
      this->work.residual[i].cwiseProduct(rowOf(this->inverse, component)).cast<float>();
  }
  Sums precondition()
  {
    this->parts.multigrid.apply(
      this->work.residual32.data(), this->work.step.data(), this->work.multigrid, this->monitor);
    const auto product = [&](Index i, int)
    {
      return Row(
        this->work.residual32[i].cast<double>().cwiseProduct(this->work.step[i].cast<double>()));
    };
    return this->unit * this->components().sumsOfRows(this->rows(), this->monitor, product);
  }
  void turn(const Sums& beta)
  {
    this->components().forRows(this->rows(), this->monitor,
      [&](Index i, int component)
      {
        Eigen::Vector4f& p = this->work.direction[i];
        p = this->work.step[i] + rowOf(beta, component).cast<float>().cwiseProduct(p);
      });
  }
  Sums apply()
  {
    return this->components().sums(this->rows(), this->monitor,
      [&](Index first, Index last, int)
      {
        Row sum = Row::Zero();
        forRowProducts(CsrRows<double>(this->parts.A), this->work.direction.data(), first, last,
          [&](Index i, const Row& product)
          {
            this->work.image[i] = product;
            sum += product.cwiseProduct(this->work.direction[i].cast<double>());
          });
        return sum;
      });
  }
  Sums step(const Sums& alpha)
  {
    return this->components().sumsOfRows(this->rows(), this->monitor,
      [&](Index i, int component)
      {
        const Row factor = rowOf(alpha, component);
        Row& r = this->work.residual[i];
        this->x[i] += factor.cwiseProduct(this->work.direction[i].cast<double>());
        r -= factor.cwiseProduct(this->work.image[i]);
        this->scaleResidual(i, component);
        return Row(r.cwiseAbs2());
      });
  }
};

SolveReport SpdSolver::solve(const RightHandSide& b, MultiVector& x, double tolerance,
  int maxIterations, Monitor& monitor) const
{
  const Parts& parts = *this->parts_;
  const auto kept = parts.workspace();
  Workspace& work = *kept;
  Iteration iteration = { parts, b, x, work, monitor };
  const Sums bNorm2 = parts.components.sumsOfRows(
    b.rows(), monitor, [&](Index i, int) { return MultiVectorRow(b[i].cwiseAbs2()); });
  Sums norm2 =
    keepBetterGuess(parts.components, b, bNorm2, iteration.residual(), x, work.residual, monitor);
  const SolverGoal goal = solverGoal(bNorm2, norm2, tolerance, maxIterations);
  SolveReport report;
  report.iterations = conjugateGradients(iteration, norm2, goal, monitor);
  goal.report(norm2, report);
  return report;
}
}
