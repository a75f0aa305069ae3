// SPDX-License-Identifier: BSD-3-Clause
#include "Solvers/GeneralSolver.h"

#include "Solvers/ConjugateGradients.h"
#include "Solvers/RowProducts.h"

#include <cmath>
#include <mutex>

namespace morph
{
struct GeneralSolver::Transposed
{
  std::mutex mutex;
  std::unique_ptr<GeneralSolver> solver; ///< made at the first use
};

GeneralSolver::GeneralSolver()
  : MultigridSolver(Multigrid::Symmetry::General)
  , transposed_(std::make_unique<Transposed>())
{
}

GeneralSolver::~GeneralSolver() = default;
GeneralSolver::GeneralSolver(GeneralSolver&&) noexcept = default;
GeneralSolver& GeneralSolver::operator=(GeneralSolver&&) noexcept = default;

void GeneralSolver::prepare(LinearEquations&& equations, Monitor& monitor)
{
  MultigridSolver::prepare(std::move(equations), monitor);
  this->transposed_ = std::make_unique<Transposed>();
  this->findNorm();
}

void GeneralSolver::findNorm()
{
  const CsrMatrix& A = this->matrix();
  const Eigen::VectorXd sums = A.cwiseAbs() * Eigen::VectorXd::Ones(A.cols());
  this->norm_ = sums.size() > 0 ? sums.maxCoeff() : 0;
}

/// One solution by BiCGSTAB, with s in place of r after its first half:
///   alpha = rho / shadow.v with v = A B p,          s = r - alpha v,      x += alpha B p,
///   omega = t.s / t.t with t = A B s,               r = s - omega t,      x += omega B s,
///   beta = (new rho / rho) (alpha / omega) with rho = shadow.r,  p = r + beta (p - omega v).
struct GeneralSolver::Iteration
{
  using Row = MultiVectorRow;

  const Parts& parts;
  const SolverGoal& goal;
  MultiVector& x;
  Workspace& work; ///< `image` is v, `direction` is p
  Monitor& monitor;
  MultiVector t;
  /// The first residual. Any vector near it serves as well.
  FloatMultiVector shadow;
  Sums unit, inverse; ///< of the floats

  Index rows() const { return this->parts.A.rows(); }
  SumsMask above(const Sums& norm2) const { return !(norm2 <= this->goal.goal2); }
  template <typename Body>
  Sums sums(const Body& body) const
  {
    return this->parts.components.sumsOfRows(this->rows(), this->monitor, body);
  }

  /// Sets the units to the size of the residual.
  void scaleTo(const Sums& norm2)
  {
    this->unit = this->parts.unscale(norm2, this->above(norm2));
    this->inverse = (this->unit > 0).select(1 / this->unit, 0);
  }
  /// Sets the step to B y, and result to A B y, for y in any units.
  void multiply(const FloatMultiVector& y, MultiVector& result)
  {
    constexpr Index Grain = 4096;
    this->parts.multigrid.apply(
      y.data(), this->work.step.data(), this->work.multigrid, this->monitor);
    this->monitor.parallelFor(this->rows(), Grain,
      [&](Index first, Index last)
      {
        rowProducts(CsrRows<double>(this->parts.A), this->work.step.data(), first, last,
          result.data() + first);
      });
  }
  /// Does x += factor step, r -= factor image; returns |r|^2.
  Sums advance(const Sums& factor, const MultiVector& image)
  {
    return this->sums(
      [&](Index i, int component)
      {
        const Row own = rowOf(factor, component);
        Row& r = this->work.residual[i];
        this->x[i] += own.cwiseProduct(this->work.step[i].cast<double>());
        r -= own.cwiseProduct(image[i]);
        return Row(r.cwiseAbs2());
      });
  }
  template <typename Vectors>
  Sums dot(const MultiVector& y, const Vectors& z) const
  {
    return this->sums(
      [&](Index i, int) { return Row(y[i].cwiseProduct(z[i].template cast<double>())); });
  }

  /// Iterates until the goal, the most iterations, or numbers that say nothing more. `norm2`: that
  /// of the residual, kept by the recurrence.
  void run(Sums& norm2, int& iterations);
};

void GeneralSolver::Iteration::run(Sums& norm2, int& iterations)
{
  constexpr double Breakdown2 = 1e-26; // of the squared cosine between residual and shadow
  const MultiVector &r = this->work.residual, &v = this->work.image;
  FloatMultiVector& p = this->work.direction;
  const auto scaled = [&](Index i, int component)
  { return Row(r[i].cwiseProduct(rowOf(this->inverse, component))); };
  this->scaleTo(norm2);
  const Sums shadowNorm2 = this->sums(
    [&](Index i, int component)
    {
      p[i] = this->shadow[i] = scaled(i, component).cast<float>();
      return Row(p[i].cast<double>().cwiseAbs2());
    });
  Sums rho = this->dot(r, this->shadow);
  while (true)
  {
    const SumsMask running = this->above(norm2);
    const bool isUsable =
      (!running || rho * rho > Breakdown2 * norm2 * shadowNorm2).all() && rho.allFinite();
    if (!running.any() || !isUsable || iterations >= this->goal.mostIterations)
    {
      return;
    }
    this->monitor.check();

    const Sums ofP = this->unit; // the directions' units
    this->multiply(p, this->work.image);
    const Sums alpha = running.select(rho / (ofP * this->dot(v, this->shadow)), 0);
    norm2 = this->advance(ofP * alpha, v);
    ++iterations;
    const SumsMask still = running && this->above(norm2);
    if (!still.any() || !norm2.allFinite())
    {
      return;
    }

    this->scaleTo(norm2);
    this->parts.components.forRows(this->rows(), this->monitor,
      [&](Index i, int component)
      { this->work.residual32[i] = scaled(i, component).cast<float>(); });
    this->multiply(this->work.residual32, this->t);
    const Sums omega =
      still.select(this->dot(this->t, r) / (this->unit * this->dot(this->t, this->t)), 0);
    norm2 = this->advance(this->unit * omega, this->t);
    ++iterations;

    const Sums before = rho;
    rho = this->dot(r, this->shadow);
    const Sums beta = still.select((rho / before) * (alpha / omega), 0);
    this->scaleTo(norm2);
    const Sums ofOld = beta * ofP * this->inverse, ofV = omega * ofOld;
    this->parts.components.forRows(this->rows(), this->monitor,
      [&](Index i, int component)
      {
        p[i] = (scaled(i, component) + rowOf(ofOld, component).cwiseProduct(p[i].cast<double>()) -
                rowOf(ofV, component).cwiseProduct(v[i]))
                 .cast<float>();
      });
    this->goal.tellProgress(norm2, this->monitor);
  }
}

SolveReport GeneralSolver::solve(const RightHandSide& b, MultiVector& x, double tolerance,
  int maxIterations, Monitor& monitor) const
{
  constexpr double Rounding = 1e-14;
  const Parts& parts = *this->parts_;
  const auto kept = parts.workspace();
  Workspace& work = *kept;
  const auto squares = [&](const auto& vectors)
  {
    return parts.components.sumsOfRows(
      b.rows(), monitor, [&](Index i, int) { return MultiVectorRow(vectors[i].cwiseAbs2()); });
  };
  const auto residual = [&] { return parts.residual(b, x, work.residual, monitor); };
  const Sums bNorm2 = squares(b);
  Sums norm2 = keepBetterGuess(parts.components, b, bNorm2, residual(), x, work.residual, monitor);
  const SolverGoal goal = solverGoal(bNorm2, norm2, tolerance, maxIterations);
  Iteration iteration = { parts, goal, x, work, monitor, MultiVector(x.size()),
    FloatMultiVector(x.size()), {}, {} };
  SolveReport report;
  // The recurrence's residual drifts from b - A x, so each run ends with a check of x and a restart
  // if that gained something.
  for (double before = HUGE_VAL, now = goal.largestRatio(norm2); now > 1 && now <= before / 2;)
  {
    iteration.run(norm2, report.iterations);
    norm2 = residual();
    goal.requireFinite(norm2, report.iterations);
    before = now;
    now = goal.largestRatio(norm2);
  }
  // Bounds the rounding error of b - A x.
  const Sums reachable = Rounding * (this->norm_ * squares(x).sqrt() + bNorm2.sqrt());
  if (!(norm2 <= goal.goal2.max(reachable.square())).all())
  {
    goal.throwTooManyIterations(norm2, report.iterations);
  }
  goal.report(norm2, report);
  return report;
}

SolveReport GeneralSolver::solveTransposed(
  const Points& b, Points& x, double tolerance, int maxIterations, Monitor& monitor) const
{
  {
    const std::lock_guard<std::mutex> lock(this->transposed_->mutex);
    if (!this->transposed_->solver)
    {
      auto fresh = std::make_unique<GeneralSolver>();
      fresh->parts_ = std::make_unique<Parts>();
      fresh->parts_->A = CsrMatrix(this->parts_->A.transpose());
      fresh->parts_->components = this->parts_->components;
      fresh->parts_->multigrid.prepareTransposed(this->parts_->multigrid, fresh->parts_->A);
      fresh->findNorm();
      this->transposed_->solver = std::move(fresh);
    }
  }
  return this->transposed_->solver->solve(b, x, tolerance, maxIterations, monitor);
}
}
