// SPDX-License-Identifier: BSD-3-Clause
#include "Optimization/Minimizers.h"

#include "Optimization/Descent.h"

#include <cmath>

namespace morph
{
namespace
{
constexpr double LinearTolerance = 0.03;
constexpr int MostLinearIterations = 100;
}

Objective::~Objective() = default;

Objective::Value Objective::valueAndGradient(
  const Points& points, Points& result, Monitor& monitor) const
{
  const Value value = this->value(points, monitor);
  if (std::isfinite(value.energy))
  {
    this->gradient(points, result, monitor);
  }
  return value;
}

Objective::Value newton(const SecondOrderObjective& objective, Points& points,
  const MinimizerLimits& limits, BlockCsr3f& matrix, MinimizerEffort& effort, Monitor& monitor)
{
  ++effort.evaluations;
  Objective::Value value = objective.value(points, monitor);
  DescentProgress progress(limits);
  LineSearch search(objective, false);
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
