// SPDX-License-Identifier: BSD-3-Clause
#include "Optimization/Minimizers.h"

#include <algorithm>
#include <cmath>

namespace morph
{
namespace
{
constexpr double LinearTolerance = 0.03;
constexpr int MostLinearIterations = 100;

constexpr Index Grain = 4096;
constexpr int MostHalvings = 40;
constexpr double SufficientDecrease = 1e-4;

/// A backtracking line search (Armijo), a full step first; a full step may double.
class LineSearch
{
public:
  /// `doublings`: of a full step, as long as each lowers the value.
  LineSearch(const Objective& objective, int doublings)
    : objective_(objective)
    , doublings_(doublings)
  {
  }

  /// Searches along `direction`. Returns false, without changes, if the slope does not descend or
  /// no step decreases enough. Between two calls only this function may change `points`.
  bool run(const Points& direction, double slope, Points& points, Objective::Value& value,
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
      monitor.parallelFor(direction.rows(), Grain,
        [&](Index first, Index last)
        {
          for (Index i = first; i < last; ++i)
          {
            to.row(free[i]) = from.row(free[i]) + length * direction.row(i);
          }
        });
    };
    double length = 1;
    for (int halving = 0; halving < MostHalvings; ++halving, length /= 2)
    {
      monitor.check();
      goTo(points, length, this->trial_);
      ++effort.evaluations;
      const Objective::Value next = this->objective_.value(this->trial_, monitor);
      if (next.allowed && std::isfinite(next.energy) &&
          next.energy <= value.energy + SufficientDecrease * length * slope)
      {
        points.swap(this->trial_);
        value = next;
        for (int doubling = 0; halving == 0 && doubling < this->doublings_; ++doubling)
        {
          this->farther_ = points;
          goTo(this->trial_, 2 * length, this->farther_);
          ++effort.evaluations;
          const Objective::Value far = this->objective_.value(this->farther_, monitor);
          if (!(far.allowed && far.energy < value.energy))
          {
            break;
          }
          length *= 2;
          points.swap(this->farther_);
          value = far;
        }
        return true;
      }
    }
    return false;
  }

private:
  const Objective& objective_;
  int doublings_;
  Points trial_, farther_; ///< memory that is kept between calls
};

/// Stopping criteria, by energies and gradient norms.
class DescentProgress
{
public:
  explicit DescentProgress(const MinimizerLimits& limits)
    : limits_(limits)
  {
  }

  bool settled(double before, double after, double norm)
  {
    this->first_ = this->first_ < 0 ? norm : this->first_;
    const double decrease = before - after;
    return decrease <= this->limits_.decrease * std::abs(after) ||
           (decrease <= this->limits_.slowDecrease * std::abs(after) &&
             norm <= this->limits_.gradientDecrease * this->first_);
  }

private:
  const MinimizerLimits& limits_;
  double first_ = -1;
};

/// The relative residual of the next linear system, by the gradients' norms. Source: Eisenstat,
/// Walker, SIAM J. Sci. Comput. 17 (1996) 16-32, choice 2 with its safeguard.
class ForcingTerm
{
public:
  double next(double norm)
  {
    if (this->norm_ > 0)
    {
      const double ratio = norm / this->norm_, safeguard = Gamma * this->term_ * this->term_;
      const double term = std::max(Gamma * ratio * ratio, safeguard > 0.1 ? safeguard : 0);
      this->term_ = std::clamp(term, LinearTolerance, Most);
    }
    this->norm_ = norm;
    return this->term_;
  }

private:
  static constexpr double Gamma = 0.9, Most = 0.3;
  double norm_ = 0, term_ = Most;
};
}

Objective::~Objective() = default;

Objective::Value newton(const SecondOrderObjective& objective, Points& points,
  const MinimizerLimits& limits, BlockCsr3f& matrix, MinimizerEffort& effort, Monitor& monitor)
{
  ++effort.evaluations;
  Objective::Value value = objective.value(points, monitor);
  DescentProgress progress(limits);
  LineSearch search(objective, limits.doublings);
  Points gradient, direction;
  ForcingTerm forcing;
  for (int step = 0; step < limits.steps; ++step)
  {
    monitor.check();
    objective.gradient(points, gradient, monitor);
    const double norm = std::sqrt(objective.rows().dot(gradient, gradient, monitor));
    if (!(norm > 0 && std::isfinite(norm)))
    {
      break;
    }
    objective.hessian(points, matrix, monitor);
    // The diagonal blocks alone need the tolerance: looser steps miss what is smooth.
    effort.linearIterations += matrix.solve(gradient, direction, LinearTolerance,
      MostLinearIterations, monitor, objective.rows(), limits.preconditioner, forcing.next(norm));
    direction *= -1;
    const double slope = objective.rows().dot(gradient, direction, monitor);
    const double before = value.energy;
    if (!search.run(direction, slope, points, value, effort, monitor))
    {
      break;
    }
    ++effort.steps;
    if (value.enough || progress.settled(before, value.energy, norm))
    {
      break;
    }
  }
  return value;
}
}
