// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Quality/ScaledJacobian.h"
#include "Quality/ValidRange.h"

#include <cmath>
#include <cstdint>
#include <vector>

/// Returns how far the interval around 0 in which `isValid(s)` holds reaches in the direction of
/// `sign`. Finds its end by steps up to `far` and by bisection to 1e-10; infinite without an end.
template <typename IsValid>
double bisectedEnd(const IsValid& isValid, double sign, double step, double far)
{
  for (double s = step; s < far; s += step)
  {
    if (isValid(sign * s))
    {
      continue;
    }
    double low = s - step, high = s;
    while (high - low > 1e-10)
    {
      const double middle = (low + high) / 2;
      (isValid(sign * middle) ? low : high) = middle;
    }
    return low;
  }
  return HUGE_VAL;
}

/// Returns the points that a motion leads to at `s`, #nodes x 3.
inline morph::Points pointsAt(const morph::NodeMotion& motion, double s)
{
  morph::Points points = *motion.base;
  if (motion.straight)
  {
    points += s * *motion.straight;
  }
  for (const morph::NodeMotion::Turn& turn : motion.turns)
  {
    points +=
      std::sin(s * turn.angle) * *turn.first + (1 - std::cos(s * turn.angle)) * *turn.second;
  }
  return points;
}

/// A motion of a mesh, of which the range is asked for.
struct RangeCase
{
  morph::Mesh mesh;
  morph::NodeMotion motion;
  std::vector<std::int8_t> orientation;

  morph::Points at(double s) const { return pointsAt(this->motion, s); }
  /// By the measure of quality.
  bool isValid(double s) const
  {
    morph::Monitor monitor;
    return morph::invertedCells(this->mesh, this->at(s), this->orientation, monitor).empty();
  }
};
