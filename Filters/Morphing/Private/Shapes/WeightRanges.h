// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Quality/ValidRange.h"

#include <string>
#include <vector>

namespace morph::filters
{
class ShapeModes;

/// The weights with which no cell gets inverted, and the boundary does not run into itself; see
/// InvertedBefore.h for cells that were inverted before. Cells are followed all the way. Crossings
/// are looked for at sixteen factors on each side of 0, and their first one is found to 2e-5 of the
/// range. A crossing between two of these factors is not seen.
struct WeightRanges
{
  /// For each shape the interval of its weight around 0, the others at their present values.
  std::vector<morph::ValidRange> Shapes;
  /// The largest factor of all present weights together: from 0 up to it, the mesh is valid so.
  /// With rotations, infinite where none is up to one full turn. NaN where the undeformed mesh is
  /// inverted.
  double LargestFactor = 0;

  /// `modes`: after Solve(). `weights`: #shapes. Cost: one validRange() a shape, and one for
  /// the factor; and some 50 crossingFaces() for each.
  static WeightRanges Find(
    const ShapeModes& modes, const std::vector<double>& weights, morph::Monitor& monitor);

  /// One line for people: "wide -0.5 to 1.25, long any". `names`: #shapes.
  std::string Text(const std::vector<std::string>& names) const;
};
}
