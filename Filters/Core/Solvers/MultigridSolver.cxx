// SPDX-License-Identifier: BSD-3-Clause
#include "Solvers/MultigridSolver.h"

#include "Solvers/ConjugateGradients.h"
#include "Support/Error.h"
#include "Support/Parallel.h"
#include "Support/ReproducibleSum.h"

#include <cassert>
#include <cmath>
#include <mutex>

namespace morph
{
void MultigridSolver::prepare(LinearEquations&& equations, Monitor& monitor)
{
  assert(equations.ghostNumbers.empty());
  const std::vector<Index> singular = equations.singularRows();
  if (!singular.empty())
  {
    throw SingularRows(singular);
  }
  auto fresh = std::make_unique<Parts>();
  fresh->A.swap(equations.matrix); // Eigen 3.4 would copy on a move
  fresh->A.makeCompressed();
  fresh->components = rowComponents(fresh->A, monitor);
  fresh->multigrid.prepare(fresh->A, this->symmetry_, equations.coordinates, monitor);
  this->parts_ = std::move(fresh);
}

void MultigridSolver::product(const Points& from, Points& to, Monitor& monitor) const
{
  const auto kept = this->parts_->workspace();
  MultiVector& rows = kept->residual;
  parallel(from.rows(), monitor, [&](Index i) { rows[i] = toRow(from.row(i)); });
  to.resize(from.rows(), 3);
  const CsrRows<double> A = this->matrix();
  parallel(A.rows, monitor,
    [&](Index i) { to.row(i) = rowSum(A, A.start[i], A.start[i + 1], rows.data()).head<3>(); });
}

void MultigridSolver::precondition(const Points& from, Points& to, Monitor& monitor) const
{
  const Index n = from.rows();
  const auto kept = this->parts_->workspace();
  Workspace& work = *kept;
  // Single precision: scales the numbers to the preconditioner's size.
  const double norm2 = dot(from, from, monitor);
  const double unscale =
    norm2 > 0 ? std::sqrt(norm2 / static_cast<double>(n)) / Multigrid::Size : 1;
  parallel(n, monitor,
    [&](Index i) { work.residual32[i] = (toRow(from.row(i)) / unscale).cast<float>(); });
  this->parts_->multigrid.apply(work.residual32.data(), work.step.data(), work.multigrid, monitor);
  const double factor = unscale / this->parts_->multigrid.unit();
  to.resize(n, 3);
  parallel(
    n, monitor, [&](Index i) { to.row(i) = factor * work.step[i].head<3>().cast<double>(); });
}

std::shared_ptr<MultigridSolver::Workspace> MultigridSolver::Parts::workspace() const
{
  std::unique_ptr<Workspace> work;
  {
    const std::lock_guard<std::mutex> lock(this->mutex);
    work.swap(this->spare);
  }
  if (!work)
  {
    work = std::make_unique<Workspace>(this->A.rows(), this->multigrid);
  }
  return { work.release(), [this](Workspace* used)
    {
      const std::lock_guard<std::mutex> lock(this->mutex);
      this->spare.reset(used);
    } };
}

Sums MultigridSolver::Parts::residual(
  const RightHandSide& b, const MultiVector& x, MultiVector& r, Monitor& monitor) const
{
  const CsrRows<double> rows = this->A;
  return this->components.sums(rows.rows, monitor,
    [&](Index i, int)
    {
      r[i] = b[i] - rowSum(rows, rows.start[i], rows.start[i + 1], x.data());
      return MultiVectorRow(r[i].cwiseAbs2());
    });
}

Sums MultigridSolver::Parts::unscale(const Sums& norm2, const SumsMask& wanted) const
{
  // By the mean over all rows: the sizes of components need not be exact.
  const auto rows = static_cast<double>(this->A.rows());
  return wanted.select((norm2 / rows).sqrt() / Multigrid::Size, 0);
}

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
    return this->unit * this->components().sums(this->rows(), this->monitor, product);
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
    const CsrRows<double> A = this->parts.A;
    const Eigen::Vector4f* p = this->work.direction.data();
    return this->components().sums(this->rows(), this->monitor,
      [&](Index i, int)
      {
        const Row product = rowSum(A, A.start[i], A.start[i + 1], p);
        this->work.image[i] = product;
        return Row(product.cwiseProduct(p[i].cast<double>()));
      });
  }
  Sums step(const Sums& alpha)
  {
    return this->components().sums(this->rows(), this->monitor,
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
  const Sums bNorm2 = parts.components.sums(
    b.rows(), monitor, [&](Index i, int) { return MultiVectorRow(b[i].cwiseAbs2()); });
  const Sums residual2 = parts.residual(b, x, work.residual, monitor);
  Sums norm2 = keepBetterGuess(parts.components, b, bNorm2, residual2, x, work.residual, monitor);
  const SolverGoal goal = solverGoal(bNorm2, norm2, tolerance, maxIterations);
  SolveReport report;
  report.iterations = conjugateGradients(iteration, norm2, goal, monitor);
  goal.report(norm2, report);
  return report;
}

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
    return this->parts.components.sums(this->rows(), this->monitor, body);
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
    const CsrRows<double> A = this->parts.A;
    const Eigen::Vector4f* step = this->work.step.data();
    this->parts.multigrid.apply(
      y.data(), this->work.step.data(), this->work.multigrid, this->monitor);
    parallel(A.rows, this->monitor,
      [&](Index i) { result[i] = rowSum(A, A.start[i], A.start[i + 1], step); });
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
    return parts.components.sums(
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
