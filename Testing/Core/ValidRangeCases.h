// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Topology.h"
#include "Meshes.h"
#include "Quality/ScaledJacobian.h"
#include "Quality/ValidRange.h"
#include "RandomMeshes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
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

/// A motion of a mesh, of which the range is asked for.
struct RangeCase
{
  morph::Mesh mesh;
  std::vector<std::int8_t> orientation;
  morph::Points first, second;
  morph::NodeMotion motion;

  /// A random motion of such a mesh, straight or by a turn.
  void moveAtRandom(bool isTurn, std::mt19937& random)
  {
    const morph::Index nodes = this->mesh.points.rows();
    this->orientation = morph::cellSigns(this->mesh, morph::connectedComponents(this->mesh));
    this->first = meshes::noise(nodes, isTurn ? .5 : 1, random);
    this->second = meshes::noise(nodes, .5, random);
    this->motion = { &this->mesh.points, &this->first, {} };
    if (isTurn)
    {
      const double angle = 1 + std::uniform_real_distribution<double>(-1, 1)(random) / 2;
      this->motion = { &this->mesh.points, nullptr, { { &this->first, &this->second, angle } } };
    }
  }
  /// Where the motion leads to at `s`, #nodes x 3.
  morph::Points at(double s) const
  {
    morph::Points points = *this->motion.base;
    if (this->motion.straight)
    {
      points += s * *this->motion.straight;
    }
    for (const morph::NodeMotion::Turn& turn : this->motion.turns)
    {
      points +=
        std::sin(s * turn.angle) * *turn.first + (1 - std::cos(s * turn.angle)) * *turn.second;
    }
    return points;
  }
  /// By the measure of quality.
  bool isValid(double s) const
  {
    morph::Monitor monitor;
    return morph::invertedCells(this->mesh, this->at(s), this->orientation, monitor).empty();
  }
  morph::ValidRange range(int threads = 1) const
  {
    meshes::ThreadedMonitor monitor(threads);
    return morph::validRange(this->mesh, this->motion, this->orientation, {}, monitor);
  }
  void expectRangeInThreads(const morph::ValidRange& range, int threads) const
  {
    const morph::ValidRange again = this->range(threads);
    EXPECT_EQ(again.lowest, range.lowest);
    EXPECT_EQ(again.highest, range.highest);
    EXPECT_EQ(again.highestCell, range.highestCell);
  }
};
