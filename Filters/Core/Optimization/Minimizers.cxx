// SPDX-License-Identifier: BSD-3-Clause
#include "Optimization/Minimizers.h"

#include <cmath>
#include <deque>
#include <limits>

namespace morph
{
namespace
{
constexpr Index Grain = 4096;
constexpr int MostHalvings = 40;
constexpr double SufficientDecrease = 1e-4;
constexpr double LinearTolerance = 0.03;
constexpr int MostLinearIterations = 100;
constexpr std::size_t Memory = 10; // of L-BFGS, in steps
constexpr double FirstStep = 1e-3; // of the mesh's size

void add(double factor, const Points& from, Points& to, Monitor& monitor)
{
  monitor.parallelFor(to.rows(), Grain,
    [&](Index first, Index last)
    { to.middleRows(first, last - first) += factor * from.middleRows(first, last - first); });
}

/// Searches along `direction`, a full step first. Returns false, without changes, if the slope does
/// not descend or no step decreases enough.
bool lineSearch(const Objective& objective, const Points& direction, double slope, Points& points,
  Objective::Value& value, MinimizerEffort& effort, Monitor& monitor)
{
  const std::vector<Index>& free = objective.free();
  Points trial = points;
  double length = 1;
  if (!(slope < 0)) // also if it is not a number
  {
    return false;
  }
  for (int halving = 0; halving < MostHalvings; ++halving, length /= 2)
  {
    monitor.check();
    monitor.parallelFor(direction.rows(), Grain,
      [&](Index first, Index last)
      {
        for (Index i = first; i < last; ++i)
        {
          trial.row(free[i]) = points.row(free[i]) + length * direction.row(i);
        }
      });
    ++effort.evaluations;
    const Objective::Value next = objective.value(trial, monitor);
    if (next.allowed && std::isfinite(next.energy) &&
        next.energy <= value.energy + SufficientDecrease * length * slope)
    {
      points.swap(trial);
      value = next;
      return true;
    }
  }
  return false;
}

/// Stopping criteria, by energies and gradient norms.
class Progress
{
public:
  explicit Progress(const MinimizerLimits& limits)
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

/// The two-loop recursion over pairs of steps and gradient differences.
class InverseHessian
{
public:
  /// `first`: how far the first step moves the node with the largest gradient, as nothing else
  /// scales it.
  InverseHessian(const Objective& objective, double first)
    : objective_(objective)
    , rows_(objective.rows())
    , first_(first)
  {
  }

  void apply(const Points& gradient, Points& direction, Monitor& monitor) const
  {
    direction = -gradient;
    if (this->pairs_.empty())
    {
      const double most = gradient.rows() > 0 ? gradient.rowwise().norm().maxCoeff() : 0;
      direction *= this->first_ / this->objective_.communicator().maximum(most);
      return;
    }
    std::vector<double> alpha(this->pairs_.size());
    for (std::size_t i = this->pairs_.size(); i-- > 0;)
    {
      const Pair& pair = this->pairs_[i];
      alpha[i] = this->rows_.dot(pair.step, direction, monitor) / pair.curvature;
      add(-alpha[i], pair.difference, direction, monitor);
    }
    const Pair& last = this->pairs_.back();
    direction *= last.curvature / this->rows_.dot(last.difference, last.difference, monitor);
    for (std::size_t i = 0; i < this->pairs_.size(); ++i)
    {
      const Pair& pair = this->pairs_[i];
      const double beta = this->rows_.dot(pair.difference, direction, monitor) / pair.curvature;
      add(alpha[i] - beta, pair.step, direction, monitor);
    }
  }

  void remember(Points step, Points difference, Monitor& monitor)
  {
    const double curvature = this->rows_.dot(step, difference, monitor);
    if (!(curvature > 0))
    {
      return;
    }
    this->pairs_.push_back({ std::move(step), std::move(difference), curvature });
    if (this->pairs_.size() > Memory)
    {
      this->pairs_.pop_front();
    }
  }

  bool empty() const { return this->pairs_.empty(); }
  void forget() { this->pairs_.clear(); }

private:
  struct Pair
  {
    Points step, difference;
    double curvature;
  };
  const Objective& objective_;
  const CopiedRows& rows_;
  double first_;
  std::deque<Pair> pairs_;
};

/// The diagonal of the box of all processes' points.
double diagonal(const Points& points, const Communicator& communicator)
{
  double squares = 0;
  for (int j = 0; j < 3; ++j)
  {
    constexpr double None = std::numeric_limits<double>::infinity();
    const bool any = points.rows() > 0;
    const double low = communicator.minimum(any ? points.col(j).minCoeff() : None),
                 high = communicator.maximum(any ? points.col(j).maxCoeff() : -None);
    squares += (high - low) * (high - low);
  }
  return std::sqrt(squares);
}
}

Objective::~Objective() = default;

Objective::Value newton(const SecondOrderObjective& objective, Points& points,
  const MinimizerLimits& limits, BlockCsr3f& matrix, MinimizerEffort& effort, Monitor& monitor)
{
  ++effort.evaluations;
  Objective::Value value = objective.value(points, monitor);
  Progress progress(limits);
  Points gradient, direction;
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
    effort.linearIterations += matrix.solve(
      -gradient, direction, LinearTolerance, MostLinearIterations, monitor, objective.rows());
    const double slope = objective.rows().dot(gradient, direction, monitor);
    const double before = value.energy;
    if (!lineSearch(objective, direction, slope, points, value, effort, monitor))
    {
      break;
    }
    ++effort.steps;
    if (progress.settled(before, value.energy, norm))
    {
      break;
    }
  }
  return value;
}

Objective::Value limitedMemoryBfgs(const Objective& objective, Points& points,
  const MinimizerLimits& limits, MinimizerEffort& effort, Monitor& monitor)
{
  ++effort.evaluations;
  Objective::Value value = objective.value(points, monitor);
  Progress progress(limits);
  InverseHessian inverse(objective, FirstStep * diagonal(points, objective.communicator()));
  Points gradient, direction;
  objective.gradient(points, gradient, monitor);
  for (int step = 0; step < limits.steps; ++step)
  {
    monitor.check();
    const double norm = std::sqrt(objective.rows().dot(gradient, gradient, monitor));
    if (!(norm > 0 && std::isfinite(norm)))
    {
      break;
    }
    inverse.apply(gradient, direction, monitor);
    double slope = objective.rows().dot(gradient, direction, monitor);
    const Points start = points(objective.free(), allColumns);
    const double before = value.energy;
    bool found = lineSearch(objective, direction, slope, points, value, effort, monitor);
    if (!found && !inverse.empty())
    {
      inverse.forget();
      inverse.apply(gradient, direction, monitor);
      slope = objective.rows().dot(gradient, direction, monitor);
      found = lineSearch(objective, direction, slope, points, value, effort, monitor);
    }
    if (!found)
    {
      break;
    }
    ++effort.steps;
    const Points old = gradient;
    objective.gradient(points, gradient, monitor);
    inverse.remember(points(objective.free(), allColumns) - start, gradient - old, monitor);
    if (progress.settled(before, value.energy, norm))
    {
      break;
    }
  }
  return value;
}
}
