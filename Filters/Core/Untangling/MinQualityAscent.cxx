// SPDX-License-Identifier: BSD-3-Clause
#include "Untangling/MinQualityAscent.h"

#include "Energies/WorstCornerNorm.h"
#include "Mesh/KRing.h"
#include "Optimization/Minimizers.h"
#include "Quality/ScaledJacobian.h"

#include <algorithm>

namespace morph
{
namespace
{
constexpr int Rounds = 16;
constexpr int Setbacks = 2; // in a row
constexpr int Steps = 40;
constexpr int Rings = 2;
// Worst are cells above the minimum m by at most these shares of m and of 1 - m.
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

bool hasFreeCorner(const Mesh& mesh, const std::vector<Index>& free, Index cell)
{
  const CellShape& shape = *cellShape(mesh.types[cell]);
  const Index* nodes = mesh.cell(cell);
  for (int k = 0; k < numberOfCorners(shape.shape); ++k)
  {
    if (std::binary_search(free.begin(), free.end(), nodes[shape.cornerNode[k]]))
    {
      return true;
    }
  }
  return false;
}
}

double significantGain(double least)
{
  return std::max(1e-6, std::min(1e-3 * least, 1e-2 * (1 - least)));
}

int raiseMinimumQuality(const Mesh& mesh, const std::vector<std::int8_t>& orientation,
  const std::vector<Index>& free, Points& points, Monitor& monitor)
{
  Quality quality = measureCorners(mesh, points, orientation, {}, monitor);
  if (!(quality.minimum > 0))
  {
    return 0;
  }
  const Adjacency around = nodeToCells(mesh);
  Points trial = points;
  double least = quality.minimum;
  Index worst = quality.worstCell;
  int kept = 0, setbacks = 0;
  for (int round = 0; round < Rounds && setbacks < Setbacks; ++round)
  {
    // A cell without a free node is fixed by the boundary: no mesh has a higher minimum.
    if (!(quality.minimum > 0) || !hasFreeCorner(mesh, free, worst))
    {
      break;
    }
    const KRing patch = kRingOfCells(mesh, around, free, worstCells(mesh, quality), Rings);
    if (patch.nodes.empty())
    {
      break;
    }
    const WorstCornerNorm angles(mesh, orientation, patch.cells, patch.nodes, quality.minimum);
    MinimizerLimits limits;
    limits.steps = Steps;
    MinimizerEffort effort;
    limitedMemoryBfgs(angles, trial, limits, effort, monitor);
    quality = measureCorners(mesh, trial, orientation, {}, monitor);
    // The sum can decrease while its largest term grows; the next round mostly compensates for it.
    // for it.
    if (quality.minimum > least + significantGain(least))
    {
      points = trial;
      least = quality.minimum;
      worst = quality.worstCell;
      ++kept;
      setbacks = 0;
    }
    else
    {
      ++setbacks;
    }
  }
  return kept;
}
}
