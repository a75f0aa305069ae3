// SPDX-License-Identifier: BSD-3-Clause
#include "Session/IncrementalMorph.h"

#include "Mesh/OwnCells.h"
#include "Quality/ScaledJacobian.h"
#include "Support/Error.h"
#include "Support/Monitor.h"

#include <algorithm>

namespace morph
{
BoundaryPath straightPath(const Points& rest, const NodePartition& partition, const Points& target)
{
  return [start = Points(rest(partition.prescribed, allColumns)), target](double time) -> Points
  {
    // Reaches the end exactly, and so keeps nodes that do not move.
    return time == 1 ? target : Points(start + time * (target - start));
  };
}

namespace
{
/// Returns the last time at which the boundary forbids nothing, by bisection down to `least`.
double lastAllowed(const SubStepLimits& limits)
{
  double allowed = 0;
  for (double step = 0.5; step >= limits.least; step /= 2)
  {
    allowed += limits.forbidden(allowed + step).empty() ? step : 0;
  }
  return allowed;
}

/// A step of takeSubSteps().
struct SubStepAttempt
{
  Points moved;                ///< #nodes x 3
  std::vector<Index> inverted; ///< or degenerate cells
  EvaluateReport report;
};

/// Calls `attempt` for steps to times up to 1. `from`: #nodes x 3, the last valid mesh, first
/// `rest`.
SubStepResult takeSubSteps(const Points& rest, const SubStepLimits& limits,
  const std::function<SubStepAttempt(const Points& from, double time, Monitor& part)>& attempt,
  Monitor& monitor)
{
  SubStepResult result;
  result.moved = rest;
  double goal = 1, step = std::min(1., limits.first);
  if (limits.forbidden && !limits.forbidden(1).empty())
  {
    // The shorter way may succeed in one step.
    goal = step = lastAllowed(limits);
    result.isForbidden = true;
  }
  int inARow = 0;
  while (result.reached < goal && result.attempts < limits.attempts &&
         result.failures < limits.failures &&
         (step >= limits.least || result.reached + step >= goal))
  {
    ProgressRange part(monitor, result.reached, std::min(1., result.reached + step));
    const double time =
      result.reached + step >= goal - limits.least / 2 ? goal : result.reached + step;
    SubStepAttempt made = attempt(result.moved, time, part);
    const int before = result.report.iterations;
    result.report = made.report;
    result.report.iterations += before;
    ++result.attempts;
    if (!made.inverted.empty())
    {
      ++result.failures;
      result.inverted.swap(made.inverted);
      step /= 2;
      inARow = 0;
      continue;
    }
    result.moved.swap(made.moved);
    result.reached = time;
    step *= ++inARow > 1 ? 2 : 1;
    step = std::min(step, goal - result.reached);
  }
  result.isForbidden = result.isForbidden && result.reached == goal;
  if (result.isForbidden)
  {
    result.inverted = limits.forbidden(std::min(1., goal + limits.least));
  }
  return result;
}
}

SubStepResult morphIncrementally(const Mesh& rest, const Points& reference,
  const NodePartition& partition, const std::vector<std::int8_t>& orientation,
  const InvertedBefore& before, const BoundaryPath& path,
  const std::function<std::unique_ptr<Morpher>()>& make, const SubStepLimits& limits,
  Monitor& whole, const std::shared_ptr<const Communicator>& processes)
{
  ProgressRange monitor(whole, 0, 1);
  const Communicator& all = processes ? *processes : Communicator::alone();
  const std::vector<std::uint8_t> others = OwnCells::others(rest, all);
  const auto inverted = [&](const Points& points)
  {
    return all.gatherCells(before.added(
      points, invertedCells(measureQuality(rest, points, orientation, others, monitor))));
  };
  const std::vector<Index> atRest = inverted(rest.points);
  if (!atRest.empty())
  {
    throw Error("The undeformed mesh has inverted or degenerate cells, so there is no valid mesh "
                "to step from: cell ids " +
                listIds(atRest) + ".");
  }
  Mesh valid = rest;
  const auto attempt = [&](const Points& from, double time, Monitor& part)
  {
    part.check();
    ProgressRange first(part, 0, 0.5), second(part, 0.5, 1);
    valid.points = from;
    std::unique_ptr<Morpher> morpher = make();
    morpher->setReference(reference);
    morpher->prepare(valid, partition, first, processes);
    SubStepAttempt made;
    made.report = morpher->evaluate(path(time), made.moved, second);
    made.inverted = inverted(made.moved);
    return made;
  };
  return takeSubSteps(rest.points, limits, attempt, monitor);
}
}
