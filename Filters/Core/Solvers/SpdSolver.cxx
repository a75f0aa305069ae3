// SPDX-License-Identifier: BSD-3-Clause
#include "Solvers/SpdSolver.h"

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
#include <memory>
#include <sstream>
#include <string>

namespace morph
{
namespace
{
constexpr Index Grain = 4096;

using Row = MultiVectorRow;
using Rows = MultiVector;

struct Workspace
{
  explicit Workspace(const Multigrid& multigrid, std::size_t n)
    : residual(largeVector<Row>(n))
    , image(largeVector<Row>(n))
    , residual32(largeVector<Eigen::Vector4f>(n))
    , direction(largeVector<Eigen::Vector4f>(n))
    , multigrid(multigrid)
  {
  }

  Rows residual, image;
  /// In units in which the first residual has Multigrid::Size. The iterate moves along the
  /// direction as rounded, so that rounding it costs no accuracy.
  FloatMultiVector residual32, direction;
  Multigrid::Workspace multigrid;

  /// `multigrid` applied to residual32. It lies in `image`, whose content is lost: an iteration
  /// reads the one before it writes the other.
  struct Step
  {
    const Eigen::Vector4f* rows;
    Row products; ///< of the columns of residual32 and these
  };
  Step precondition(const Multigrid& preconditioner, Monitor& monitor)
  {
    const FloatHalves halves(this->image);
    const Row products = preconditioner.apply(
      this->residual32.data(), halves.first, halves.second, this->multigrid, monitor);
    return { halves.second, products };
  }
};

/// `reached`: the state of the iteration.
[[noreturn]] void throwNoConvergence(const std::string& reached)
{
  throw Error(Error::Kind::NoConvergence,
    "The conjugate gradients did not converge: " + reached +
      " Look for inverted or nearly flat cells in the undeformed mesh, or raise the tolerance.");
}

[[noreturn]] void throwTooManyIterations(int iterations, double residual, double tolerance)
{
  std::ostringstream text;
  text << "after " << iterations << " iterations the relative residual is " << residual << " where "
       << tolerance << " is asked for.";
  throwNoConvergence(text.str());
}

/// Projects the constrained rows onto their directions.
template <typename Vectors>
void project(const RowConstraints& constraints, Vectors& x)
{
  using Scalar = typename Vectors::value_type::Scalar;
  for (std::size_t i = 0; i < constraints.rows.size(); ++i)
  {
    auto row = x[constraints.rows[i]].template head<3>();
    row = (constraints.directions[i] * row.template cast<double>()).template cast<Scalar>().eval();
  }
}

void requireFinite(const Row& norm2, int iterations)
{
  if (!norm2.allFinite())
  {
    throwNoConvergence(
      "their numbers overflowed after " + std::to_string(iterations) + " iterations.");
  }
}
}

struct SpdSolver::Implementation
{
  MixedPrecisionMatrix A;
  RowComponents components;
  Multigrid preconditioner;
  SpareWorkspace<Workspace> spare;

  std::unique_ptr<Workspace> takeWorkspace()
  {
    return this->spare.take(
      [this] { return std::make_unique<Workspace>(this->preconditioner, this->A.rows()); });
  }
  std::size_t workspaceBytes() const
  {
    return this->A.rows() * (2 * sizeof(Row) + 2 * sizeof(Eigen::Vector4f)) +
           this->preconditioner.workspaceBytes();
  }
  void giveBack(std::unique_ptr<Workspace> workspace)
  {
    this->spare.giveBack(std::move(workspace), this->workspaceBytes());
  }

  /// Sets the residual to b - A x and the direction to zero; returns the squared norms.
  Row trueResidual(
    const RightHandSide& b, const Rows& solution, Workspace& work, Monitor& monitor) const;
  SolveReport iterate(const RightHandSide& b, Rows& solution, Workspace& work, double tolerance,
    int maxIterations, Monitor& monitor) const;
  SolveReport iterateConstrained(const Points& b, const RowConstraints& constraints, Rows& solution,
    double tolerance, int maxIterations, Monitor& monitor) const;
};

SpdSolver::SpdSolver() = default;
SpdSolver::~SpdSolver() = default;
SpdSolver::SpdSolver(SpdSolver&&) noexcept = default;
SpdSolver& SpdSolver::operator=(SpdSolver&&) noexcept = default;

void SpdSolver::prepare(
  MixedPrecisionMatrix matrix, const ConstPoints& coordinates, Monitor& monitor)
{
  auto fresh = std::make_unique<Implementation>();
  fresh->A = std::move(matrix);
  const Index rows = fresh->A.rows();
  const Eigen::VectorXd diagonal = fresh->A.diagonal(monitor);
  std::vector<Index> notPositive;
  for (Index i = 0; i < rows; ++i)
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
  fresh->components = rowComponents(fresh->A.rounded(), monitor);
  fresh->preconditioner.prepare(fresh->A, Multigrid::Symmetry::Symmetric, coordinates, monitor);
  fresh->A.narrowColumns(monitor);
  this->implementation_ = std::move(fresh);
}

Row SpdSolver::Implementation::trueResidual(
  const RightHandSide& b, const Rows& solution, Workspace& work, Monitor& monitor) const
{
  return reproducibleSumOfBlocks(this->A.rows(), monitor, Row(Row::Zero()),
    [&](Index first, Index last)
    {
      Row norm2 = Row::Zero();
      forRowProducts(this->A, solution.data(), first, last,
        [&](Index i, const Row& product)
        {
          work.residual[i] = b[i] - product;
          work.direction[i] = Eigen::Vector4f::Zero();
          norm2 += work.residual[i].cwiseAbs2();
        });
      return norm2;
    });
}

SolveReport SpdSolver::Implementation::iterate(const RightHandSide& b, Rows& solution,
  Workspace& work, double tolerance, int maxIterations, Monitor& monitor) const
{
  const Index n = this->A.rows();
  Rows &residual = work.residual, &image = work.image;
  FloatMultiVector& direction = work.direction;
  const Row zero = Row::Zero();

  const Row bNorm2 =
    reproducibleSum(n, monitor, zero, [&](Index i) { return Row(b[i].cwiseAbs2()); });
  Row norm2 = keepBetterGuess(this->components, b, bNorm2,
    this->trueResidual(b, solution, work, monitor), solution, residual, monitor);
  if (!bNorm2.allFinite() || !norm2.allFinite())
  {
    throw Error("The prescribed displacements are too large to compute with (beyond 1e150).");
  }
  const double floor2 = 1e-28 * bNorm2.sum();
  const Row goal2 = (tolerance * tolerance * bNorm2).cwiseMax(floor2);
  const double atStart = largestRatio(norm2, goal2);

  SolveReport report;
  int restarts = 0;
  // The recurrence's residual drifts from b - A x, so each run ends with a check of x and a restart
  // if rounding allows.
  for (double before = HUGE_VAL; largestRatio(norm2, goal2) > 1; ++restarts)
  {
    const double now = largestRatio(norm2, goal2);
    if (now > 0.5 * before)
    {
      break;
    }
    before = now;

    // The preconditioner has single precision: scales each column's residual to its size.
    Row scale = zero, unscale = zero;
    for (int c = 0; c < 4; ++c)
    {
      if (norm2[c] > goal2[c])
      {
        unscale[c] = std::sqrt(norm2[c] / static_cast<double>(n)) / Multigrid::Size;
        scale[c] = 1 / unscale[c];
      }
    }
    monitor.parallelFor(n, Grain,
      [&](Index first, Index last)
      {
        for (Index i = first; i < last; ++i)
        {
          work.residual32[i] = residual[i].cwiseProduct(scale).cast<float>();
        }
      });

    Row rz = zero;
    for (bool first = true;; first = false)
    {
      Eigen::Array4i running = Eigen::Array4i::Zero();
      for (int c = 0; c < 4; ++c)
      {
        running[c] = !(norm2[c] <= goal2[c]);
      }
      if (!running.any())
      {
        break;
      }
      requireFinite(norm2, report.iterations);
      if (report.iterations == maxIterations)
      {
        throwTooManyIterations(report.iterations, largestRatio(norm2, bNorm2), tolerance);
      }
      monitor.check();

      const Workspace::Step step = work.precondition(this->preconditioner, monitor);
      const Row rzBefore = rz;
      rz = unscale.cwiseProduct(step.products);
      const Row beta = first ? zero : ratio(rz, rzBefore, running);
      monitor.parallelFor(n, Grain,
        [&](Index from, Index to)
        {
          for (Index i = from; i < to; ++i)
          {
            direction[i] =
              (step.rows[i].cast<double>() + beta.cwiseProduct(direction[i].cast<double>()))
                .cast<float>();
          }
        });
      const Row curvature = reproducibleSumOfBlocks(n, monitor, zero,
        [&](Index from, Index to)
        {
          rowProducts(this->A, direction.data(), from, to, image.data() + from);
          Row sum = zero;
          for (Index i = from; i < to; ++i)
          {
            sum += image[i].cwiseProduct(direction[i].cast<double>());
          }
          return sum;
        });
      // The direction's unit cancels: it is in both numbers.
      const Row alpha = ratio(rz, curvature, running);
      norm2 = reproducibleSum(n, monitor, zero,
        [&](Index i)
        {
          solution[i] += alpha.cwiseProduct(direction[i].cast<double>());
          residual[i] -= alpha.cwiseProduct(image[i]);
          work.residual32[i] = residual[i].cwiseProduct(scale).cast<float>();
          return Row(residual[i].cwiseAbs2());
        });
      ++report.iterations;
      const double left = largestRatio(norm2, goal2);
      if (left > 1 && atStart > 1)
      {
        monitor.progress(std::clamp(1 - std::log(left) / std::log(atStart), 0., 1.));
      }
    }
    norm2 = this->trueResidual(b, solution, work, monitor);
    requireFinite(norm2, report.iterations);
  }

  for (int c = 0; c < 4; ++c)
  {
    // A residual of 1e-13 of the whole is rounding, however small the column is.
    if (bNorm2[c] > floor2 && norm2[c] > 100 * floor2)
    {
      report.relativeResidual = std::max(report.relativeResidual, std::sqrt(norm2[c] / bNorm2[c]));
    }
  }
  const double pass = this->A.bytesRead() + (6. * sizeof(Row) + 6. * sizeof(Eigen::Vector4f)) * n;
  report.bytesMoved = (report.iterations + 1 + restarts) * pass +
                      report.iterations * this->preconditioner.bytesMoved();
  return report;
}

SolveReport SpdSolver::Implementation::iterateConstrained(const Points& b,
  const RowConstraints& constraints, Rows& solution, double tolerance, int maxIterations,
  Monitor& monitor) const
{
  const Index n = this->A.rows();
  Rows residual(n), direction(n), image(n), step(n);
  FloatMultiVector residual32(n), step32(n), scratch(n);
  Multigrid::Workspace multigrid(this->preconditioner);
  const auto sum = [&](const auto& body) { return reproducibleSum(n, monitor, 0., body); };
  const auto findResidual = [&]
  {
    monitor.parallelFor(n, Grain,
      [&](Index first, Index last)
      {
        forRowProducts(this->A, solution.data(), first, last,
          [&](Index i, const Row& product) { residual[i] = toRow(b.row(i)) - product; });
      });
    project(constraints, residual);
    return sum([&](Index i) { return residual[i].squaredNorm(); });
  };
  const double ofSolution2 = reproducibleSumOfBlocks(n, monitor, 0.,
    [&](Index first, Index last)
    {
      double sum = 0;
      forRowProducts(this->A, solution.data(), first, last,
        [&](Index, const Row& product) { sum += product.squaredNorm(); });
      return sum;
    });
  const double given2 = std::max(sum([&](Index i) { return b.row(i).squaredNorm(); }), ofSolution2);
  const double goal2 = std::max(tolerance * tolerance, 1e-28) * given2;
  double norm2 = findResidual();
  if (!std::isfinite(given2) || !std::isfinite(norm2))
  {
    throw Error("The prescribed displacements are too large to compute with (beyond 1e150).");
  }

  SolveReport report;
  for (double before = HUGE_VAL; norm2 > goal2 && norm2 <= 0.25 * before;)
  {
    before = norm2;
    // The preconditioner has single precision: scales the residual to its size.
    const double unscale = std::sqrt(norm2 / static_cast<double>(n)) / Multigrid::Size;
    double rz = 0;
    for (bool first = true; norm2 > goal2; first = false)
    {
      if (!std::isfinite(norm2))
      {
        throwNoConvergence(
          "their numbers overflowed after " + std::to_string(report.iterations) + " iterations.");
      }
      if (report.iterations == maxIterations)
      {
        throwTooManyIterations(report.iterations, std::sqrt(norm2 / given2), tolerance);
      }
      monitor.check();
      for (Index i = 0; i < n; ++i)
      {
        residual32[i] = (residual[i] / unscale).cast<float>();
      }
      this->preconditioner.apply(
        residual32.data(), scratch.data(), step32.data(), multigrid, monitor);
      for (Index i = 0; i < n; ++i)
      {
        step[i] = unscale * step32[i].cast<double>();
      }
      project(constraints, step);
      const double rzBefore = rz;
      rz = sum([&](Index i) { return residual[i].dot(step[i]); });
      const double beta = first ? 0 : rz / rzBefore;
      for (Index i = 0; i < n; ++i)
      {
        direction[i] = first ? step[i] : Row(step[i] + beta * direction[i]);
      }
      const double curvature = reproducibleSumOfBlocks(n, monitor, 0.,
        [&](Index from, Index to)
        {
          rowProducts(this->A, direction.data(), from, to, image.data() + from);
          double sum = 0;
          for (Index i = from; i < to; ++i)
          {
            sum += image[i].dot(direction[i]);
          }
          return sum;
        });
      project(constraints, image);
      const double alpha = rz / curvature;
      norm2 = sum(
        [&](Index i)
        {
          solution[i] += alpha * direction[i];
          residual[i] -= alpha * image[i];
          return residual[i].squaredNorm();
        });
      ++report.iterations;
    }
    norm2 = findResidual();
  }
  report.relativeResidual = given2 > 0 ? std::sqrt(norm2 / given2) : 0;
  report.bytesMoved =
    report.iterations * (this->A.bytesRead() + 12. * sizeof(Row) * static_cast<double>(n) +
                          this->preconditioner.bytesMoved());
  return report;
}

SolveReport SpdSolver::solveConstrained(const Points& b, const RowConstraints& constraints,
  Points& x, double tolerance, int maxIterations, Monitor& monitor) const
{
  Rows solution = toRows(x, monitor);
  const SolveReport report = this->implementation_->iterateConstrained(
    b, constraints, solution, tolerance, maxIterations, monitor);
  fromRows(solution, x, monitor);
  return report;
}

void SpdSolver::precondition(const Points& from, Points& to, Monitor& monitor) const
{
  const Index n = from.rows();
  std::unique_ptr<Workspace> work = this->implementation_->takeWorkspace();
  // Single precision: scales the numbers to the preconditioner's size.
  const double norm2 =
    reproducibleSum(n, monitor, 0., [&](Index i) { return from.row(i).squaredNorm(); });
  const double unscale =
    norm2 > 0 ? std::sqrt(norm2 / static_cast<double>(n)) / Multigrid::Size : 1;
  monitor.parallelFor(n, Grain,
    [&](Index first, Index last)
    {
      for (Index i = first; i < last; ++i)
      {
        work->residual32[i] = (toRow(from.row(i)) / unscale).cast<float>();
      }
    });
  const Eigen::Vector4f* step =
    work->precondition(this->implementation_->preconditioner, monitor).rows;
  const double factor = unscale / this->implementation_->A.unit();
  to.resize(n, 3);
  monitor.parallelFor(n, Grain,
    [&](Index first, Index last)
    {
      for (Index i = first; i < last; ++i)
      {
        to.row(i) = factor * step[i].head<3>().cast<double>();
      }
    });
  this->implementation_->giveBack(std::move(work));
}

Points SpdSolver::product(const Points& x, Monitor& monitor) const
{
  Points result(x.rows(), 3);
  const Rows rows = toRows(x, monitor);
  monitor.parallelFor(x.rows(), Grain,
    [&](Index first, Index last)
    {
      forRowProducts(this->matrix(), rows.data(), first, last,
        [&](Index i, const Row& product) { result.row(i) = product.head<3>(); });
    });
  return result;
}

SolveReport SpdSolver::solve(const RightHandSide& b, MultiVector& x, double tolerance,
  int maxIterations, Monitor& monitor) const
{
  std::unique_ptr<Workspace> work = this->implementation_->takeWorkspace();
  const SolveReport report =
    this->implementation_->iterate(b, x, *work, tolerance, maxIterations, monitor);
  this->implementation_->giveBack(std::move(work));
  return report;
}

SolveReport SpdSolver::solve(
  const Points& b, Points& x, double tolerance, int maxIterations, Monitor& monitor) const
{
  return solveColumns(*this, b, x, tolerance, maxIterations, monitor);
}

Eigen::VectorXd SpdSolver::diagonal(Monitor& monitor) const
{
  return this->matrix().diagonal(monitor);
}

const MixedPrecisionMatrix& SpdSolver::matrix() const
{
  return this->implementation_->A;
}

const RowComponents& SpdSolver::components() const
{
  return this->implementation_->components;
}

std::size_t SpdSolver::memory() const
{
  const Implementation& my = *this->implementation_;
  return my.A.memory() + 4 * my.components.ofRow.size() + my.preconditioner.memory() +
         my.workspaceBytes();
}
}
