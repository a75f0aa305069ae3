// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Optimization/Minimizers.h"

namespace morph
{
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
