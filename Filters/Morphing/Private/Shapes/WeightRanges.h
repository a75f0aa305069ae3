// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Quality/ValidRange.h"

#include <string>
#include <vector>

namespace morph::filters
{
class ShapeModes;

/// The weights with which no cell gets inverted; see InvertedBefore.h for those that were before.
struct WeightRanges
{
  /// For each shape the interval of its weight around 0, the others at their present values.
  std::vector<morph::ValidRange> Shapes;
  /// The largest factor of all present weights together: from 0 up to it, no cell is inverted. With
  /// rotations, infinite where none is up to one full turn. NaN where the undeformed mesh is
  /// inverted.
  double LargestFactor = 0;

  /// `modes`: after Solve(). `weights`: #shapes. Cost: one validRange() a shape, and one for
  /// the factor.
  static WeightRanges Find(
    const ShapeModes& modes, const std::vector<double>& weights, morph::Monitor& monitor);

  /// One line for people: "wide -0.5 to 1.25, long any". `names`: #shapes.
  std::string Text(const std::vector<std::string>& names) const;
};
}
