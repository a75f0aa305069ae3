// SPDX-License-Identifier: BSD-3-Clause
#include "Optimization/Descent.h"

#include "Support/Parallel.h"

#include <cmath>

namespace morph
{
namespace
{
constexpr int MostHalvings = 40;
constexpr double SufficientDecrease = 1e-4;
}

bool LineSearch::run(const Points& direction, double slope, Points& points, Objective::Value& value,
  MinimizerEffort& effort, Monitor& monitor)
{
  if (!(slope < 0)) // also if it is not a number
  {
    return false;
  }
  const std::vector<Index>& free = this->objective_.free();
  if (this->trial_.rows() != points.rows())
  {
    this->trial_ = points;
  }
  const auto goTo = [&](const Points& from, double length, Points& to)
  {
    parallel(direction.rows(), monitor,
      [&](Index i) { to.row(free[i]) = from.row(free[i]) + length * direction.row(i); });
  };
  this->length_ = 1;
  for (int halving = 0; halving < MostHalvings; ++halving, this->length_ /= 2)
  {
    monitor.check();
    goTo(points, this->length_, this->trial_);
    ++effort.evaluations;
    this->hasGradient_ = this->keepsGradient_ && halving == 0;
    const Objective::Value next =
      this->hasGradient_ ? this->objective_.valueAndGradient(this->trial_, this->gradient_, monitor)
                         : this->objective_.value(this->trial_, monitor);
    if (next.allowed && std::isfinite(next.energy) &&
        next.energy <= value.energy + SufficientDecrease * this->length_ * slope)
    {
      points.swap(this->trial_);
      value = next;
      for (int doubling = 0; halving == 0 && doubling < this->doublings_; ++doubling)
      {
        this->farther_ = points;
        goTo(this->trial_, 2 * this->length_, this->farther_);
        ++effort.evaluations;
        const Objective::Value far = this->objective_.value(this->farther_, monitor);
        if (!(far.allowed && far.energy < value.energy))
        {
          break;
        }
        this->length_ *= 2;
        points.swap(this->farther_);
        value = far;
      }
      return true;
    }
  }
  return false;
}

void LineSearch::gradient(const Points& points, Points& result, Monitor& monitor)
{
  if (this->hasGradient_)
  {
    result.swap(this->gradient_);
    this->hasGradient_ = false;
    return;
  }
  this->objective_.gradient(points, result, monitor);
}

bool DescentProgress::settled(double before, double after, double norm)
{
  this->first_ = this->first_ < 0 ? norm : this->first_;
  const double decrease = before - after;
  return decrease <= this->limits_.decrease * std::abs(after) ||
         (decrease <= this->limits_.slowDecrease * std::abs(after) &&
           norm <= this->limits_.gradientDecrease * this->first_);
}
}
