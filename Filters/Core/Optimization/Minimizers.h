// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Optimization/Objective.h"

namespace morph
{
/// The summed effort of minimizations.
struct MinimizerEffort
{
  Index steps = 0;
  Index linearIterations = 0; ///< of Newton's linear systems
  Index evaluations = 0;      ///< of the objective's value
};

struct MinimizerLimits
{
  int steps = 30;
  /// stops after a step that lowers the energy by less than this, relative
  double decrease = 1e-6;
  /// Also stops after a step that lowers the energy by less than slowDecrease, relative, if the
  /// norm of the gradient is below gradientDecrease times the first.
  double slowDecrease = 1e-4;
  double gradientDecrease = 1e-2;
  /// How many steps in a row have to say so in limitedMemoryBfgs(), which knows the curvature along
  /// a few directions alone at first.
  int settledSteps = 1;
  /// How often newton() may double a full step, as long as that lowers the energy.
  int doublings = 0;
  /// for Newton's linear systems, beside their diagonal blocks; null: none
  const NodePreconditioner* preconditioner = nullptr;
};

/// Minimizes by Newton's method with conjugate gradients and a backtracking line search (Armijo).
/// `points`: #nodes x 3, start and result. Only the objective's free nodes move, and the energy
/// never increases. `matrix`: memory for the second derivatives, kept between calls. Returns the
/// final value. Throws Error of kind Cancelled, leaving `points` at the last step.
Objective::Value newton(const SecondOrderObjective& objective, Points& points,
  const MinimizerLimits& limits, BlockCsr3f& matrix, MinimizerEffort& effort, Monitor& monitor);

/// Minimizes by the limited-memory BFGS method with the last ten steps. It needs no matrix, but 0.5
/// kB a free node; otherwise as newton(). Source: Liu, Nocedal, Math. Program. 45 (1989) 503-528.
Objective::Value limitedMemoryBfgs(const Objective& objective, Points& points,
  const MinimizerLimits& limits, MinimizerEffort& effort, Monitor& monitor);

/// A backtracking line search (Armijo), a full step first; a full step may double.
class LineSearch
{
public:
  /// `keepsGradient`: the gradient is wanted after each step, and costs little beside a value.
  /// `doublings`: of a full step, as long as each lowers the value.
  LineSearch(const Objective& objective, bool keepsGradient, int doublings = 0)
    : objective_(objective)
    , keepsGradient_(keepsGradient)
    , doublings_(doublings)
  {
  }

  /// Searches along `direction`. Returns false, without changes, if the slope does not descend or
  /// no step decreases enough. Between two calls only this function may change `points`.
  bool run(const Points& direction, double slope, Points& points, Objective::Value& value,
    MinimizerEffort& effort, Monitor& monitor);
  /// The part of the direction that the last step has gone.
  double length() const { return this->length_; }
  /// Computes the gradient after a step, or takes that of its value.
  void gradient(const Points& points, Points& result, Monitor& monitor);

private:
  const Objective& objective_;
  bool keepsGradient_;
  int doublings_;
  bool hasGradient_ = false;
  double length_ = 1;
  Points trial_, farther_, gradient_; ///< memory that is kept between calls
};

/// Stopping criteria, by energies and gradient norms.
class DescentProgress
{
public:
  explicit DescentProgress(const MinimizerLimits& limits)
    : limits_(limits)
  {
  }

  bool settled(double before, double after, double norm);

private:
  const MinimizerLimits& limits_;
  double first_ = -1;
};
}
