// SPDX-License-Identifier: BSD-3-Clause
#include "Solvers/GeneralSolver.h"

#include "Solvers/Gmres.h"
#include "Solvers/MixedPrecisionMatrix.h"
#include "Solvers/MultiVector.h"
#include "Solvers/Multigrid.h"
#include "Solvers/RowProducts.h"
#include "Solvers/SpareWorkspace.h"
#include "Support/Error.h"
#include "Support/HugePages.h"
#include "Support/ReproducibleSum.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <sstream>
#include <string>

namespace morph
{
namespace
{
constexpr Index Grain = 4096;
constexpr double Rounding = 1e-14;
constexpr double BreakdownCosine = 1e-13;
constexpr int StagnationWindow = 24;     // iterations
constexpr double StagnationFactor = 0.1; // by which they must reduce the residual
constexpr int Warm = 8;                  // iterations that a first run may take before it converges

using Row = MultiVectorRow;
using Rows = MultiVector;
using Two = Eigen::Matrix<double, 4, 2>; ///< two sums in one pass

struct Workspace
{
  Workspace(const Multigrid& hierarchy, std::size_t n)
    : residual(largeVector<Row>(n))
    , direction(largeVector<Eigen::Vector4f>(n))
    , shadow(largeVector<Eigen::Vector4f>(n))
    , image(largeVector<Row>(n))
    , second(largeVector<Row>(n))
    , step(largeVector<Eigen::Vector4f>(n))
    , multigrid(hierarchy)
  {
  }

  Rows residual;
  /// In units of `scale`. The iterate moves along the direction as rounded and preconditioned, so
  /// that rounding it costs no accuracy.
  FloatMultiVector direction;
  /// The first residual, in units of `scale`. Any vector near it serves as well.
  FloatMultiVector shadow;
  /// A times the preconditioned direction, and times the preconditioned residual; `second` is
  /// scratch memory for the preconditioner before
  Rows image, second;
  FloatMultiVector step; ///< from the preconditioner, in units of `scale`
  Multigrid::Workspace multigrid;
};

/// Selects the columns above their goals.
Eigen::Array4i above(const Row& norm2, const Row& goal2)
{
  Eigen::Array4i running = Eigen::Array4i::Zero();
  for (int c = 0; c < 4; ++c)
  {
    running[c] = !(norm2[c] <= goal2[c]);
  }
  return running;
}
}

/// A or its transpose, with its hierarchy.
struct GeneralSolver::System
{
  MixedPrecisionMatrix A;
  RowComponents components;
  Multigrid preconditioner;
  double norm = 0; ///< largest row sum of |A|

  SpareWorkspace<Workspace> spare;

  std::unique_ptr<Workspace> takeWorkspace() const
  {
    return this->spare.take(
      [this] { return std::make_unique<Workspace>(this->preconditioner, this->A.rows()); });
  }
  std::size_t workspaceBytes() const
  {
    return this->A.rows() * (3 * sizeof(Row) + 3 * sizeof(Eigen::Vector4f)) +
           this->preconditioner.workspaceBytes();
  }
  void giveBack(std::unique_ptr<Workspace> workspace) const
  {
    this->spare.giveBack(std::move(workspace), this->workspaceBytes());
  }

  void findNorm(Monitor& monitor)
  {
    std::vector<float> sums;
    absoluteRowSums(this->A.rounded(), sums, monitor);
    this->norm = sums.empty() ? 0 : this->A.unit() * *std::max_element(sums.begin(), sums.end());
  }

  std::size_t memory() const
  {
    return this->A.memory() + 4 * this->components.ofRow.size() + this->preconditioner.memory() +
           this->workspaceBytes();
  }

  /// Sets the residual to b - A x; returns the squared norms.
  Row trueResidual(const RightHandSide& b, const Rows& x, Workspace& work, Monitor& monitor) const;
  /// Sets the step to B times the direction.
  void preconditionDirection(Workspace& work, Monitor& monitor) const;
  /// Sets the step to B (scale residual).
  void preconditionResidual(const Row& scale, Workspace& work, Monitor& monitor) const;
  /// Runs BiCGSTAB from x until it reaches the goal, stagnates or breaks down.
  /// `norm2` becomes that of the recurrence's residual: the caller has to compute the true one.
  void bicgstab(Rows& x, Row& norm2, const Row& goal2, Workspace& work, int maxIterations,
    Report& report, Monitor& monitor, const std::function<void(double)>& progress) const;
  Report solve(const RightHandSide& b, MultiVector& x, double tolerance, int maxIterations,
    Monitor& monitor) const;
  Report solve(
    const Points& b, Points& x, double tolerance, int maxIterations, Monitor& monitor) const
  {
    MultiVector rows = toRows(x, monitor);
    const Report report = this->solve(toRows(b, monitor), rows, tolerance, maxIterations, monitor);
    fromRows(rows, x, monitor);
    return report;
  }
};

Row GeneralSolver::System::trueResidual(
  const RightHandSide& b, const Rows& x, Workspace& work, Monitor& monitor) const
{
  return reproducibleSumOfBlocks(this->A.rows(), monitor, Row(Row::Zero()),
    [&](Index first, Index last)
    {
      Row norm2 = Row::Zero();
      forRowProducts(this->A, x.data(), first, last,
        [&](Index i, const Row& product)
        {
          work.residual[i] = b[i] - product;
          norm2 += work.residual[i].cwiseAbs2();
        });
      return norm2;
    });
}

void GeneralSolver::System::preconditionDirection(Workspace& work, Monitor& monitor) const
{
  const FloatHalves scratch(work.second);
  this->preconditioner.apply(
    work.direction.data(), scratch.first, work.step.data(), work.multigrid, monitor);
}

void GeneralSolver::System::preconditionResidual(
  const Row& scale, Workspace& work, Monitor& monitor) const
{
  const FloatHalves scratch(work.second);
  monitor.parallelFor(this->A.rows(), Grain,
    [&](Index first, Index last)
    {
      for (Index i = first; i < last; ++i)
      {
        scratch.first[i] = work.residual[i].cwiseProduct(scale).cast<float>();
      }
    });
  this->preconditioner.apply(
    scratch.first, scratch.second, work.step.data(), work.multigrid, monitor);
}

void GeneralSolver::System::bicgstab(Rows& x, Row& norm2, const Row& goal2, Workspace& work,
  int maxIterations, Report& report, Monitor& monitor,
  const std::function<void(double)>& progress) const
{
  const Index n = this->A.rows();
  const Row zero = Row::Zero();
  Rows &residual = work.residual, &image = work.image, &second = work.second;
  FloatMultiVector& direction = work.direction;

  // The preconditioner has single precision: scales each column's residual to its size.
  Row scale = zero, unscale = zero;
  const auto rescale = [&]
  {
    for (int c = 0; c < 4; ++c)
    {
      unscale[c] =
        norm2[c] > goal2[c] ? std::sqrt(norm2[c] / static_cast<double>(n)) / Multigrid::Size : 0;
      scale[c] = unscale[c] > 0 ? 1 / unscale[c] : 0;
    }
  };

  rescale();
  const Two begin = reproducibleSum(n, monitor, Two(Two::Zero()),
    [&](Index i)
    {
      direction[i] = work.shadow[i] = residual[i].cwiseProduct(scale).cast<float>();
      const Row shadow = work.shadow[i].cast<double>();
      Two pair;
      pair << residual[i].cwiseProduct(shadow), shadow.cwiseAbs2();
      return pair;
    });
  Row rho = begin.col(0);
  const Row shadowNorm2 = begin.col(1);
  double windowStart = largestRatio(norm2, goal2);
  const int firstIteration = report.iterations;
  int windowEnd = firstIteration + StagnationWindow + Warm;
  while (true)
  {
    const Eigen::Array4i running = above(norm2, goal2);
    if (!running.any())
    {
      return;
    }
    for (int c = 0; c < 4; ++c)
    {
      if (running[c] &&
          !(std::abs(rho[c]) > BreakdownCosine * std::sqrt(norm2[c]) * std::sqrt(shadowNorm2[c])))
      {
        return;
      }
    }
    if (report.iterations >= maxIterations)
    {
      return;
    }
    monitor.check();

    const Row firstUnscale = unscale;
    this->preconditionDirection(work, monitor);
    const Row along = reproducibleSumOfBlocks(n, monitor, zero,
      [&](Index first, Index last)
      {
        Row sum = zero;
        forRowProducts(this->A, work.step.data(), first, last,
          [&](Index i, const Row& product)
          {
            image[i] = product.cwiseProduct(firstUnscale);
            sum += image[i].cwiseProduct(work.shadow[i].cast<double>());
          });
        return sum;
      });
    ++report.iterations;
    const Row alpha = ratio(rho, along, running);
    if (!alpha.allFinite())
    {
      return;
    }
    norm2 = reproducibleSum(n, monitor, zero,
      [&](Index i)
      {
        residual[i] -= alpha.cwiseProduct(image[i]);
        x[i] += alpha.cwiseProduct(firstUnscale).cwiseProduct(work.step[i].cast<double>());
        return Row(residual[i].cwiseAbs2());
      });
    const Eigen::Array4i still = running * above(norm2, goal2);
    if (!still.any())
    {
      return;
    }

    rescale();
    this->preconditionResidual(scale, work, monitor);
    const Two products = reproducibleSumOfBlocks(n, monitor, Two(Two::Zero()),
      [&](Index first, Index last)
      {
        Two pair = Two::Zero();
        forRowProducts(this->A, work.step.data(), first, last,
          [&](Index i, const Row& product)
          {
            second[i] = product.cwiseProduct(unscale);
            pair.col(0) += second[i].cwiseProduct(residual[i]);
            pair.col(1) += second[i].cwiseAbs2();
          });
        return pair;
      });
    ++report.iterations;
    const Row omega = ratio(products.col(0), products.col(1), still);
    if (!omega.allFinite())
    {
      return;
    }
    const Two sums = reproducibleSum(n, monitor, Two(Two::Zero()),
      [&](Index i)
      {
        x[i] += omega.cwiseProduct(unscale).cwiseProduct(work.step[i].cast<double>());
        residual[i] -= omega.cwiseProduct(second[i]);
        Two pair;
        pair << residual[i].cwiseAbs2(), residual[i].cwiseProduct(work.shadow[i].cast<double>());
        return pair;
      });
    norm2 = sums.col(0);
    const Row rhoBefore = rho;
    rho = sums.col(1);
    if (!sums.allFinite())
    {
      return;
    }
    const Row beta = ratio(rho, rhoBefore, still).cwiseProduct(ratio(alpha, omega, still));
    if (!beta.allFinite())
    {
      return;
    }
    rescale();
    const Row ofDirection = beta.cwiseProduct(firstUnscale).cwiseProduct(scale);
    const Row ofImage = beta.cwiseProduct(omega).cwiseProduct(scale);
    monitor.parallelFor(n, Grain,
      [&](Index first, Index last)
      {
        for (Index i = first; i < last; ++i)
        {
          direction[i] = (residual[i].cwiseProduct(scale) +
                          ofDirection.cwiseProduct(direction[i].cast<double>()) -
                          ofImage.cwiseProduct(image[i]))
                           .cast<float>();
        }
      });

    const double left = largestRatio(norm2, goal2);
    progress(left);
    if (report.iterations >= windowEnd)
    {
      if (left > StagnationFactor * windowStart)
      {
        return;
      }
      windowStart = left;
      windowEnd = report.iterations + StagnationWindow;
    }
  }
}

GeneralSolver::Report GeneralSolver::System::solve(const RightHandSide& b, MultiVector& x,
  double tolerance, int maxIterations, Monitor& monitor) const
{
  const Index n = this->A.rows();
  std::unique_ptr<Workspace> work = this->takeWorkspace();
  const Row bNorm2 =
    reproducibleSum(n, monitor, Row(Row::Zero()), [&](Index i) { return Row(b[i].cwiseAbs2()); });
  Row norm2 = keepBetterGuess(this->components, b, bNorm2, this->trueResidual(b, x, *work, monitor),
    x, work->residual, monitor);
  if (!bNorm2.allFinite() || !norm2.allFinite())
  {
    throw Error("The prescribed displacements are too large to compute with (beyond 1e150).");
  }
  const double floor2 = Rounding * Rounding * bNorm2.sum();
  const Row goal2 = (tolerance * tolerance * bNorm2).cwiseMax(floor2);
  const double atStart = largestRatio(norm2, goal2);
  const auto progress = [&](double left)
  {
    if (left > 1 && atStart > 1)
    {
      monitor.progress(std::clamp(1 - std::log(left) / std::log(atStart), 0., 1.));
    }
  };
  // Bounds the rounding error of b - A x for such an x.
  const auto reachable2 = [&]
  {
    const Row xNorm2 =
      reproducibleSum(n, monitor, Row(Row::Zero()), [&](Index i) { return Row(x[i].cwiseAbs2()); });
    return Row(Row(Rounding * (this->norm * xNorm2.cwiseSqrt() + bNorm2.cwiseSqrt())).cwiseAbs2());
  };

  const auto reached = [&]
  {
    const Row limit2 = goal2.cwiseMax(reachable2());
    return limit2.allFinite() && (norm2.array() <= limit2.array()).all();
  };

  Report report;
  int runs = 0;
  // The recurrence's residual drifts from b - A x, so each run ends with a check of x and perhaps a
  // restart.
  bool stuck = false;
  while (!stuck && above(norm2, goal2).any() && report.iterations < maxIterations)
  {
    const double before = largestRatio(norm2, goal2);
    this->bicgstab(x, norm2, goal2, *work, maxIterations, report, monitor, progress);
    norm2 = this->trueResidual(b, x, *work, monitor);
    stuck = !norm2.allFinite() || largestRatio(norm2, goal2) > 0.5 * before;
    ++runs;
  }
  if (above(norm2, goal2).any() && !reached())
  {
    if (!norm2.allFinite() || largestRatio(norm2, goal2) >= atStart)
    {
      std::fill(x.begin(), x.end(), Row(Row::Zero()));
      norm2 = this->trueResidual(b, x, *work, monitor);
    }
    const auto fail = [&](const std::string& reached)
    {
      throw Error(Error::Kind::NoConvergence, "The linear solver did not converge: " + reached +
                                                " Look for inverted or nearly flat cells in the "
                                                "undeformed mesh, or raise the tolerance.");
    };
    const CsrMatrix matrix = this->A.toCsr();
    Gmres gmres(matrix);
    // Each run of GMRES ends with the true residual.
    for (double before = HUGE_VAL; above(norm2, goal2).any();)
    {
      const double now = largestRatio(norm2, goal2);
      if (now > 0.5 * before && reached())
      {
        break;
      }
      if (report.fallBackIterations >= maxIterations)
      {
        std::ostringstream text;
        text << "after " << report.iterations << " iterations the relative residual is "
             << largestRatio(norm2, bNorm2) << " where " << tolerance << " is asked for.";
        fail(text.str());
      }
      before = now;
      const int made = gmres.run(b, norm2, goal2, x, monitor);
      report.iterations += made;
      report.fallBackIterations += made;
      norm2 = this->trueResidual(b, x, *work, monitor);
      if (!norm2.allFinite())
      {
        fail("its numbers overflowed after " + std::to_string(report.iterations) + " iterations.");
      }
      progress(largestRatio(norm2, goal2));
    }
    std::ostringstream text;
    text << "BiCGSTAB stagnated; GMRES finished the solution in " << report.fallBackIterations
         << " iterations. Look for inverted or nearly flat cells in the undeformed mesh.";
    monitor.warn(text.str());
  }

  for (int c = 0; c < 4; ++c)
  {
    // A residual of 1e-13 of the whole is rounding, however small the column is.
    if (bNorm2[c] > floor2 && norm2[c] > 100 * floor2)
    {
      report.relativeResidual = std::max(report.relativeResidual, std::sqrt(norm2[c] / bNorm2[c]));
    }
  }
  this->giveBack(std::move(work));
  const double pass = this->A.bytesRead() + (8. * sizeof(Row) + 4. * sizeof(Eigen::Vector4f)) * n;
  report.bytesMoved =
    (report.iterations + 1 + runs) * pass + report.iterations * this->preconditioner.bytesMoved();
  return report;
}

struct GeneralSolver::Implementation
{
  System forward;
  std::mutex mutex;
  std::unique_ptr<System> transposed; ///< made at the first use

  const System& transposedSystem(Monitor& monitor)
  {
    const std::lock_guard<std::mutex> lock(this->mutex);
    if (!this->transposed)
    {
      auto fresh = std::make_unique<System>();
      const CsrMatrix matrix = this->forward.A.toCsr().transpose();
      fresh->A = MixedPrecisionMatrix(matrix, monitor);
      fresh->components = this->forward.components;
      fresh->findNorm(monitor);
      fresh->preconditioner.prepareTransposed(this->forward.preconditioner, fresh->A);
      fresh->A.narrowColumns(monitor);
      this->transposed = std::move(fresh);
    }
    return *this->transposed;
  }
};

GeneralSolver::GeneralSolver() = default;
GeneralSolver::~GeneralSolver() = default;
GeneralSolver::GeneralSolver(GeneralSolver&&) noexcept = default;
GeneralSolver& GeneralSolver::operator=(GeneralSolver&&) noexcept = default;

void GeneralSolver::prepare(
  MixedPrecisionMatrix matrix, const ConstPoints& coordinates, Monitor& monitor)
{
  auto fresh = std::make_unique<Implementation>();
  System& system = fresh->forward;
  system.A = std::move(matrix);
  const Eigen::VectorXd diagonal = system.A.diagonal(monitor);
  std::vector<Index> notPositive;
  for (Index i = 0; i < diagonal.size(); ++i)
  {
    if (!(diagonal[i] > 0 && std::isfinite(diagonal[i])))
    {
      notPositive.push_back(i);
    }
  }
  if (!notPositive.empty())
  {
    throw SingularRows(notPositive);
  }
  system.findNorm(monitor);
  system.components = rowComponents(system.A.rounded(), monitor);
  system.preconditioner.prepare(system.A, Multigrid::Symmetry::General, coordinates, monitor);
  system.A.narrowColumns(monitor);
  this->implementation_ = std::move(fresh);
}

GeneralSolver::Report GeneralSolver::solve(
  const Points& b, Points& x, double tolerance, int maxIterations, Monitor& monitor) const
{
  return this->implementation_->forward.solve(b, x, tolerance, maxIterations, monitor);
}

GeneralSolver::Report GeneralSolver::solve(const RightHandSide& b, MultiVector& x, double tolerance,
  int maxIterations, Monitor& monitor) const
{
  return this->implementation_->forward.solve(b, x, tolerance, maxIterations, monitor);
}

GeneralSolver::Report GeneralSolver::solveTransposed(
  const Points& b, Points& x, double tolerance, int maxIterations, Monitor& monitor) const
{
  return this->implementation_->transposedSystem(monitor).solve(
    b, x, tolerance, maxIterations, monitor);
}

const MixedPrecisionMatrix& GeneralSolver::matrix() const
{
  return this->implementation_->forward.A;
}

const RowComponents& GeneralSolver::components() const
{
  return this->implementation_->forward.components;
}

std::size_t GeneralSolver::memory() const
{
  const std::lock_guard<std::mutex> lock(this->implementation_->mutex);
  return this->implementation_->forward.memory() +
         (this->implementation_->transposed ? this->implementation_->transposed->memory() : 0);
}
}
