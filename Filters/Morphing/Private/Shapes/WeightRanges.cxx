// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Shapes/WeightRanges.h"

#include "Morpher/Blend.h"
#include "Private/Shapes/ShapeModes.h"
#include "Support/ProgressRange.h"

#include <cmath>
#include <limits>
#include <sstream>

namespace morph::filters
{
namespace
{
/// The range in which the cells of all processes are valid.
void join(const RankGroup& processes, morph::ValidRange& range)
{
  range.isEmpty = processes.Any(range.isEmpty);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double lowest = processes.Maximum(range.isEmpty ? 0 : range.lowest);
  const double highest = processes.Minimum(range.isEmpty ? 0 : range.highest);
  range.lowest = range.isEmpty ? nan : lowest;
  range.highest = range.isEmpty ? nan : highest;
  range.lowestCell = range.highestCell = -1; // of different processes
}

std::string endText(double end)
{
  if (std::isinf(end))
  {
    return "any";
  }
  std::ostringstream text;
  text.precision(4);
  text << end;
  return text.str();
}
}

WeightRanges WeightRanges::Find(
  const ShapeModes& modes, const std::vector<double>& weights, morph::Monitor& monitor)
{
  const RankGroup& processes = modes.Group();
  WeightRanges result;
  morph::Points base;
  const morph::InvertedBefore& before = modes.GetSolver()->Before(monitor);
  processes.Together(
    [&]
    {
      for (std::size_t i = 0; i < weights.size(); ++i)
      {
        const double share = 1. / static_cast<double>(weights.size() + 1);
        morph::ProgressRange part(
          monitor, share * static_cast<double>(i), share * static_cast<double>(i + 1));
        std::vector<double> others = weights;
        others[i] = 0;
        morph::blend(modes.Mesh().points, modes.Weighted(others), base, part);
        result.Shapes.push_back(morph::validRange(
          modes.Mesh(), modes.MotionOf(i, base), modes.Orientation(), before, part));
      }
      morph::Points straight;
      result.LargestFactor = morph::validRange(modes.Mesh(),
        modes.Combined(weights, straight, monitor), modes.Orientation(), before, monitor)
                               .highest;
    });
  for (morph::ValidRange& range : result.Shapes)
  {
    join(processes, range);
  }
  const bool isUnknown = std::isnan(result.LargestFactor);
  const bool isAnyUnknown = processes.Any(isUnknown);
  const double factor = processes.Minimum(isUnknown ? 0 : result.LargestFactor);
  result.LargestFactor = isAnyUnknown ? std::numeric_limits<double>::quiet_NaN() : factor;
  return result;
}

std::string WeightRanges::Text(const std::vector<std::string>& names) const
{
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
  {
    const morph::ValidRange& range = this->Shapes[i];
    text += (i > 0 ? ", " : "") + names[i] + " ";
    if (range.isEmpty)
    {
      text += "none";
    }
    else if (std::isinf(range.lowest) && std::isinf(range.highest))
    {
      text += "any";
    }
    else
    {
      text += endText(range.lowest) + " to " + endText(range.highest);
    }
  }
  return text;
}
}
