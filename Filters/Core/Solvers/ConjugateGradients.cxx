// SPDX-License-Identifier: BSD-3-Clause
#include "Solvers/ConjugateGradients.h"

#include "Support/Error.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace morph
{
void reportRounding(const SolveReport& report, double tolerance, Monitor& monitor)
{
  // Within a factor of ten, and below 1e-13, the difference is not visible.
  if (report.relativeResidual > std::max(10 * tolerance, 1e-13))
  {
    std::ostringstream text;
    text << "Rounding kept the relative residual at " << report.relativeResidual << " where "
         << tolerance << " is asked for: the undeformed mesh has cells that are nearly flat.";
    monitor.warn(text.str());
  }
}

namespace
{
constexpr double Rounding2 = 1e-28;

Sums ofAllColumns(const Sums& norm2)
{
  return norm2.rowwise().sum().replicate(1, norm2.cols());
}

[[noreturn]] void throwNoConvergence(const std::string& reached)
{
  throw Error(Error::Kind::NoConvergence, "The linear solver did not converge: " + reached +
                                            " Look for inverted or nearly flat cells in the "
                                            "undeformed mesh, or raise the tolerance.");
}
}

SolverGoal solverGoal(const Sums& bNorm2, const Sums& norm2, double tolerance, int mostIterations)
{
  if (!bNorm2.allFinite() || !norm2.allFinite())
  {
    throw Error("The prescribed displacements are too large to compute with (beyond 1e150).");
  }
  SolverGoal goal;
  goal.bNorm2 = bNorm2;
  goal.goal2 = (tolerance * tolerance * bNorm2).max(Rounding2 * ofAllColumns(bNorm2));
  goal.tolerance = tolerance;
  goal.mostIterations = mostIterations;
  goal.atStart = goal.largestRatio(norm2);
  return goal;
}

double SolverGoal::largestRatio(const Sums& norm2) const
{
  return norm2.size() == 0
           ? 0
           : std::sqrt((norm2 / this->goal2.max(1e-300)).maxCoeff<Eigen::PropagateNaN>());
}

void SolverGoal::tellProgress(const Sums& norm2, Monitor& monitor) const
{
  const double left = this->largestRatio(norm2);
  if (left > 1 && this->atStart > 1)
  {
    monitor.progress(std::clamp(1 - std::log(left) / std::log(this->atStart), 0., 1.));
  }
}

void SolverGoal::report(const Sums& norm2, SolveReport& report) const
{
  const Sums floor2 = Rounding2 * ofAllColumns(this->bNorm2);
  const auto counts = this->bNorm2 > floor2 && norm2 > 100 * floor2;
  report.relativeResidual =
    norm2.size() == 0 ? 0 : std::sqrt(counts.select(norm2 / this->bNorm2, 0).maxCoeff());
}

void SolverGoal::requireFinite(const Sums& norm2, int iterations) const
{
  if (!norm2.allFinite())
  {
    throwNoConvergence(
      "its numbers overflowed after " + std::to_string(iterations) + " iterations.");
  }
}

void SolverGoal::throwTooManyIterations(const Sums& norm2, int iterations) const
{
  std::ostringstream text;
  text << "after " << iterations << " iterations the relative residual is "
       << std::sqrt((norm2 / this->bNorm2.max(1e-300)).maxCoeff()) << " where " << this->tolerance
       << " is asked for.";
  throwNoConvergence(text.str());
}

Sums PointsSystem::residual()
{
  this->A(this->x, this->work.r);
  parallel(this->b.rows(), this->monitor,
    [&](Index i) { this->work.r.row(i) = this->b.row(i) - this->work.r.row(i); });
  this->project(this->work.r);
  return this->one(this->dot(this->work.r, this->work.r));
}

// Dot products with r and p are those of the unprojected vectors: both lie in the range of P.

Sums PointsSystem::precondition()
{
  this->B(this->work.r, this->work.z);
  this->project(this->work.z);
  return this->one(this->dot(this->work.r, this->work.z));
}

void PointsSystem::turn(const Sums& beta)
{
  parallel(this->b.rows(), this->monitor,
    [&](Index i) { this->work.p.row(i) = this->work.z.row(i) + beta(0, 0) * this->work.p.row(i); });
}

Sums PointsSystem::apply()
{
  this->A(this->work.p, this->work.Ap);
  this->project(this->work.Ap);
  return this->one(this->dot(this->work.p, this->work.Ap));
}

Sums PointsSystem::step(const Sums& alpha)
{
  parallel(this->b.rows(), this->monitor,
    [&](Index i)
    {
      this->x.row(i) += alpha(0, 0) * this->work.p.row(i);
      this->work.r.row(i) -= alpha(0, 0) * this->work.Ap.row(i);
    });
  return this->one(this->dot(this->work.r, this->work.r));
}
}
