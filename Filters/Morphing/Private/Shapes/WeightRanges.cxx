// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Shapes/WeightRanges.h"

#include "Morpher/Blend.h"
#include "Private/Shapes/ShapeModes.h"
#include "Support/Monitor.h"

#include <algorithm>
#include <cmath>
#include <functional>
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

/// The nodes at a factor.
morph::Points positions(const morph::NodeMotion& motion, double factor)
{
  morph::Points at = *motion.base;
  if (motion.straight)
  {
    at += factor * *motion.straight;
  }
  for (const morph::NodeMotion::Turn& turn : motion.turns)
  {
    const double half = std::sin(factor * turn.angle / 2);
    at += std::sin(factor * turn.angle) * *turn.first + 2 * half * half * *turn.second;
  }
  return at;
}

/// The factor at which nodes have moved by the mesh's size, or turned once: the boundary meets no
/// more of itself beyond it. 0 without a motion.
double farthest(const morph::NodeMotion& motion, const ShapeModes& modes)
{
  double most = motion.straight && motion.straight->rows() > 0
                  ? std::sqrt(motion.straight->rowwise().squaredNorm().maxCoeff()) /
                      modes.GetSolver()->Rest().size()
                  : 0;
  for (const morph::NodeMotion::Turn& turn : motion.turns)
  {
    most = std::max(most, std::abs(turn.angle) / (2 * std::acos(-1.)));
  }
  most = modes.Group().Maximum(most);
  return most > 0 ? 1 / most : 0;
}

/// Ends a range before the first of Samples factors, evenly spaced from 0 on, at which the boundary
/// runs into itself.
void excludeCrossings(
  const ShapeModes& modes, const morph::NodeMotion& motion, double& end, morph::Monitor& monitor)
{
  constexpr int Samples = 16, Halvings = 12;
  const auto crosses = [&](double factor)
  { return modes.GetSolver()->Crosses(positions(motion, factor), monitor); };
  const double far = farthest(motion, modes);
  const double last = std::isinf(end) ? std::copysign(far, end) : end;
  for (int k = 1; far > 0 && last != 0 && k <= Samples; ++k)
  {
    if (crosses(last * k / Samples))
    {
      double free = last * (k - 1) / Samples, crossing = last * k / Samples;
      for (int i = 0; i < Halvings; ++i)
      {
        const double middle = (free + crossing) / 2;
        (crosses(middle) ? crossing : free) = middle;
      }
      end = free;
      return;
    }
  }
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
  const morph::InvertedBefore& before = modes.GetSolver()->Before(monitor);
  const auto rangeOf = [&](const std::function<morph::NodeMotion()>& motionOf, morph::Monitor& part)
  {
    morph::NodeMotion motion;
    morph::ValidRange range;
    processes.Together(
      [&]
      {
        motion = motionOf();
        range = morph::validRange(modes.Mesh(), motion, modes.Orientation(), before, part);
      });
    join(processes, range);
    if (!range.isEmpty && modes.GetSolver()->Crosses(*motion.base, part))
    {
      range.isEmpty = true;
      range.lowest = range.highest = std::numeric_limits<double>::quiet_NaN();
    }
    if (!range.isEmpty)
    {
      excludeCrossings(modes, motion, range.lowest, part);
      excludeCrossings(modes, motion, range.highest, part);
    }
    return range;
  };
  morph::Points base, straight;
  for (std::size_t i = 0; i < weights.size(); ++i)
  {
    const double share = 1. / static_cast<double>(weights.size() + 1);
    morph::ProgressRange part(
      monitor, share * static_cast<double>(i), share * static_cast<double>(i + 1));
    const auto motionOf = [&]
    {
      std::vector<double> others = weights;
      others[i] = 0;
      morph::blend(modes.Mesh().points, modes.Weighted(others), base, part);
      return modes.MotionOf(i, base);
    };
    result.Shapes.push_back(rangeOf(motionOf, part));
  }
  result.LargestFactor =
    rangeOf([&] { return modes.Combined(weights, straight, monitor); }, monitor).highest;
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
