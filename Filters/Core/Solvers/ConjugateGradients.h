// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Solvers/RowComponents.h"
#include "Support/Monitor.h"
#include "Support/Parallel.h"
#include "Support/Types.h"

#include <functional>
#include <string>

namespace morph
{
/// The effort of an iterative solution.
struct SolveReport
{
  int iterations = 0; ///< of all right-hand sides together
  /// maximum of |b - A x| / |b| over the right-hand sides, computed from x
  double relativeResidual = 0;
};

/// Warns if rounding kept the residual above the `tolerance`.
void reportRounding(const SolveReport& report, double tolerance, Monitor& monitor);

/// What a linear solver aims at: |r|^2 <= goal2 in each column of each component, and its first
/// residual r = b - A x.
struct SolverGoal
{
  Sums bNorm2;          ///< |b|^2
  Sums goal2;           ///< for |r|^2
  double tolerance = 0; ///< that was asked for
  int mostIterations = 0;
  double atStart = 0; ///< largestRatio() of the first residual; 0: progress is not told

  /// Returns the largest |r| in parts of its goal; NaN where a norm is NaN.
  double largestRatio(const Sums& norm2) const;
  bool isReached(const Sums& norm2) const { return (norm2 <= this->goal2).all(); }
  void tellProgress(const Sums& norm2, Monitor& monitor) const;
  /// Sets the relative residual. A residual of 1e-13 of the component's whole is rounding, however
  /// small its column is.
  void report(const Sums& norm2, SolveReport& report) const;

  /// Throw Error of kind NoConvergence.
  ///@{
  void requireFinite(const Sums& norm2, int iterations) const;
  [[noreturn]] void throwTooManyIterations(const Sums& norm2, int iterations) const;
  ///@}
};

/// The goal for norms of b: in each column the tolerance, or 1e-14 of its component's three columns
/// together, which ends columns of pure rounding. Throws Error where |b| or the first residual is
/// too large to compute with.
SolverGoal solverGoal(const Sums& bNorm2, const Sums& norm2, double tolerance, int mostIterations);

/// One run of preconditioned conjugate gradients for A x = b (Hestenes and Stiefel, J. Res. NBS 49
/// (1952) 409-436): from p = z = B r repeatedly
///   alpha = r.z / p.Ap,  x += alpha p,  r -= alpha Ap,  z = B r,
///   beta = new r.z / old r.z,  p = z + beta p.
/// The system has the vectors and, for each column and component, the numbers:
///   begin(norm2, running)  prepares r for B, and sets p = 0
///   precondition()         sets z, returns r.z
///   turn(beta)             sets p
///   apply()                sets Ap, returns p.Ap
///   step(alpha)            sets x and r, returns |r|^2
/// alpha and beta are 0 where the goal is reached. `norm2`: |r|^2, kept. Returns whether the run
/// ended at the goal or the most iterations. Otherwise it met a direction that shows A or B not to
/// be positive definite, or not to be numbers.
template <typename System>
bool runConjugateGradients(
  System& system, Sums& norm2, const SolverGoal& goal, int& iterations, Monitor& monitor)
{
  const auto running = [&] { return SumsMask(!(norm2 <= goal.goal2)); };
  const auto positive = [&](const Sums& numbers)
  { return (numbers > 0 || norm2 <= goal.goal2).all(); };
  const Sums zero = Sums::Zero(norm2.rows(), norm2.cols());
  system.begin(norm2, running());
  Sums rz = zero, before;
  for (bool first = true; !goal.isReached(norm2) && iterations < goal.mostIterations; first = false)
  {
    monitor.check();
    before = rz;
    rz = system.precondition();
    if (!positive(rz))
    {
      return false;
    }
    system.turn(first ? zero : Sums(running().select(rz / before, 0)));
    const Sums curvature = system.apply();
    if (!positive(curvature))
    {
      return false;
    }
    norm2 = system.step(running().select(rz / curvature, 0));
    ++iterations;
    goal.tellProgress(norm2, monitor);
  }
  return true;
}

/// Conjugate gradients down to the goal, or to rounding. The recurrence's residual drifts from
/// b - A x. So each run ends with system.residual(), which sets r to it and returns |r|^2. The next
/// run starts there, as long as they halve it. `norm2`: of the first residual, then of the last.
/// Returns the iterations. Throws Error of kind NoConvergence.
template <typename System>
int conjugateGradients(System& system, Sums& norm2, const SolverGoal& goal, Monitor& monitor)
{
  int iterations = 0;
  for (double before = HUGE_VAL, now = goal.largestRatio(norm2); now > 1 && now <= before / 2;)
  {
    runConjugateGradients(system, norm2, goal, iterations, monitor);
    if (iterations == goal.mostIterations && !goal.isReached(norm2))
    {
      goal.throwTooManyIterations(norm2, iterations);
    }
    norm2 = system.residual();
    goal.requireFinite(norm2, iterations);
    before = now;
    now = goal.largestRatio(norm2);
  }
  return iterations;
}

/// The vectors of a PointsSystem, #rows x 3 each, for one run after another: new memory would cost
/// as much as an iteration where pages are dear.
struct PointsVectors
{
  Points r, z, p, Ap;
};

/// A system for conjugate gradients whose three columns are iterated as one, by any operators. With
/// `project`, an orthogonal projection P, it solves P A x = P b for x that differ from the guess by
/// vectors of P's range.
struct PointsSystem
{
  using Operator = std::function<void(const Points& from, Points& to)>;
  Operator A, B;
  std::function<double(const Points& a, const Points& b)> dot;
  const Points& b;
  Points& x; ///< the guess
  Monitor& monitor;
  PointsVectors& work;
  std::function<void(Points& x)> project = [](Points&) {};

  Sums one(double value) const { return Sums::Constant(1, 1, value); }
  Sums residual();
  void begin(const Sums&, const SumsMask&) { this->work.p.setZero(this->b.rows(), 3); }
  Sums precondition();
  void turn(const Sums& beta);
  Sums apply();
  Sums step(const Sums& alpha);
};
}
