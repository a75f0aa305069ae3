// SPDX-License-Identifier: BSD-3-Clause
#include "WorstCells.h"

#include "CellPatch.h"
#include "CornerAngles.h"
#include "Minimizers.h"
#include "ScaledJacobian.h"

#include <algorithm>

namespace morph
{
namespace
{
constexpr int Rounds = 6;
constexpr int Steps = 40;
constexpr int Rings = 2;
constexpr double LeastGain = 1e-3;
// Worst are the cells that are less than this above the least: of it, and of the way to 1.
constexpr double OfTheLeast = 0.5, OfTheWay = 0.1;

std::vector<Index> worstCells(const Mesh& mesh, const Quality& quality)
{
  const double least = quality.minimum;
  const double limit = least + std::min(OfTheLeast * least, OfTheWay * (1 - least));
  std::vector<Index> worst;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    if (quality.scaledJacobian[c] <= limit && numberOfCorners(cellShape(mesh.types[c])->shape) > 0)
    {
      worst.push_back(c);
    }
  }
  return worst;
}
}

int raiseWorstCells(const Mesh& mesh, const std::vector<std::int8_t>& orientation,
  const std::vector<Index>& free, Points& points, Monitor& monitor)
{
  Quality quality = measureQuality(mesh, points, orientation, {}, monitor);
  if (!(quality.minimum > 0))
  {
    return 0;
  }
  const Adjacency around = nodeToCells(mesh);
  for (int round = 0; round < Rounds; ++round)
  {
    const CellPatch patch = cellPatch(mesh, around, free, worstCells(mesh, quality), Rings);
    if (patch.nodes.empty())
    {
      return round;
    }
    const CornerAngles angles(mesh, orientation, patch.cells, patch.nodes, quality.minimum);
    MinimizerLimits limits;
    limits.steps = Steps;
    MinimizerEffort effort;
    Points trial = points;
    limitedMemoryBfgs(angles, trial, limits, effort, monitor);
    Quality next = measureQuality(mesh, trial, orientation, {}, monitor);
    if (!(next.minimum > (1 + LeastGain) * quality.minimum))
    {
      return round;
    }
    points.swap(trial);
    quality = std::move(next);
  }
  return Rounds;
}
}
