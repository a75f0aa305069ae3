// SPDX-License-Identifier: BSD-3-Clause
#include "SubSteps.h"

#include "Error.h"
#include "ScaledJacobian.h"
#include "SubMonitor.h"

#include <algorithm>

namespace morph
{
BoundaryPath straightPath(const Points& rest, const NodePartition& partition, const Points& target)
{
  Points start(target.rows(), 3);
  for (Index i = 0; i < start.rows(); ++i)
  {
    start.row(i) = rest.row(partition.prescribed[i]);
  }
  return [start, target](double time) -> Points
  {
    // The end exactly, and so every node that does not move.
    return time == 1 ? target : Points(start + time * (target - start));
  };
}

std::vector<Index> invertedCells(const Mesh& mesh, const Points& points,
  const std::vector<std::int8_t>& orientation, Monitor& monitor)
{
  return invertedCells(measureQuality(mesh, points, orientation, {}, monitor));
}

SubStepResult followInSubSteps(const Mesh& rest, const Points& reference,
  const NodePartition& partition, const std::vector<std::int8_t>& orientation,
  const BoundaryPath& path, const std::function<std::unique_ptr<Morpher>()>& make,
  const SubStepLimits& limits, Monitor& monitor)
{
  const std::vector<Index> atRest = invertedCells(rest, rest.points, orientation, monitor);
  if (!atRest.empty())
  {
    throw Error(
      "The mesh at rest has inverted or degenerate cells, so there is no valid mesh to step from: "
      "cell ids " +
      listIds(atRest) +
      ". Repair them first, for instance by the inversion-free morph of the mesh at rest.");
  }
  SubStepResult result;
  result.moved = rest.points;
  Mesh valid = rest;
  double step = std::min(1., limits.first);
  int inARow = 0;
  while (result.reached < 1 && result.attempts < limits.attempts &&
         (step >= limits.least || result.reached + step >= 1))
  {
    monitor.check();
    SubMonitor part(monitor, result.reached, std::min(1., result.reached + step));
    const double time = result.reached + step >= 1 - limits.least / 2 ? 1 : result.reached + step;
    std::unique_ptr<Morpher> morpher = make();
    morpher->setReference(reference);
    morpher->prepare(valid, partition, part);
    Points moved;
    const int before = result.report.iterations;
    result.report = morpher->evaluate(path(time), moved, part);
    result.report.iterations += before;
    ++result.attempts;

    result.inverted = invertedCells(rest, moved, orientation, part);
    if (!result.inverted.empty())
    {
      step /= 2;
      inARow = 0;
      continue;
    }
    valid.points = moved;
    result.moved.swap(moved);
    result.reached = time;
    step *= ++inARow > 1 ? 2 : 1;
    step = std::min(step, 1 - result.reached);
  }
  return result;
}
}
