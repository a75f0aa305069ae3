// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Shapes/WeightRanges.h"

#include "Morpher/Blend.h"
#include "Private/Shapes/ShapeModes.h"

#include <cmath>
#include <limits>
#include <sstream>

namespace morph::filters
{
namespace
{
double largestFactor(const ShapeModes& modes, const std::vector<double>& weights,
  const morph::Points& moved, morph::Monitor& monitor)
{
  for (std::size_t i = 0; i < weights.size(); ++i)
  {
    if (modes.IsRotation(i) && weights[i] != 0)
    {
      return std::numeric_limits<double>::quiet_NaN();
    }
  }
  const morph::Points motion = moved - modes.GetKept().Mesh().points;
  const morph::NodeMotion whole = { &modes.GetKept().Mesh().points, &motion };
  return morph::validRange(modes.GetKept().Mesh(), whole, modes.GetKept().Orientation(), monitor)
    .highest;
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

WeightRanges WeightRanges::Find(const ShapeModes& modes, const std::vector<double>& weights,
  const morph::Points& moved, morph::Monitor& monitor)
{
  WeightRanges result;
  morph::Points base;
  for (std::size_t i = 0; i < weights.size(); ++i)
  {
    monitor.check();
    std::vector<double> others = weights;
    others[i] = 0;
    morph::blend(modes.GetKept().Mesh().points, modes.Weighted(others), base, monitor);
    result.Shapes.push_back(morph::validRange(
      modes.GetKept().Mesh(), modes.MotionOf(i, base), modes.GetKept().Orientation(), monitor));
  }
  result.LargestFactor = largestFactor(modes, weights, moved, monitor);
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
