// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Shapes/WeightRanges.h"

#include "Morpher/Blend.h"
#include "Private/Shapes/ShapeModes.h"

#include <cmath>
#include <sstream>

namespace morph::filters
{
namespace
{
/// `ranges`: of the shapes' weights.
double largestFactor(const ShapeModes& modes, const std::vector<double>& weights,
  const std::vector<morph::ValidRange>& ranges, const morph::Points& moved, morph::Monitor& monitor)
{
  const morph::Mesh& mesh = modes.GetKept().Mesh();
  const std::vector<std::int8_t>& orientation = modes.GetKept().Orientation();
  std::vector<std::size_t> weighted, turned;
  for (std::size_t i = 0; i < weights.size(); ++i)
  {
    if (weights[i] != 0)
    {
      weighted.push_back(i);
      if (modes.IsRotation(i))
      {
        turned.push_back(i);
      }
    }
  }
  if (turned.empty())
  {
    const morph::Points motion = moved - mesh.points;
    return morph::validRange(mesh, { &mesh.points, &motion }, orientation, monitor).highest;
  }
  if (weighted.size() == 1)
  {
    const double weight = weights[turned[0]];
    const morph::ValidRange& range = ranges[turned[0]]; // the others are at 0
    return (weight > 0 ? range.highest : range.lowest) / weight;
  }
  morph::Points straight;
  const morph::CombinedMotion motion = modes.Combined(weights, straight, monitor);
  return morph::largestFactor(mesh, motion, orientation, monitor).factor;
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
  result.LargestFactor = largestFactor(modes, weights, result.Shapes, moved, monitor);
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
