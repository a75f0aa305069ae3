// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Morpher/Morpher.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace morph
{
/// The prescribed positions, #prescribed x 3, at a time from 0 (at rest) to 1.
using BoundaryPath = std::function<Points(double time)>;

/// The straight path from the partition's nodes in `rest` to `target`.
BoundaryPath straightPath(const Points& rest, const NodePartition& partition, const Points& target);

struct SubStepLimits
{
  double first = 0.5;      ///< the first step tried, of the whole motion
  double least = 1. / 256; ///< no step is shorter
  Index attempts = 64;     ///< failed ones included
  Index failures = 16;     ///< attempts that may fail in all: failing takes a method longest
  /// The cells that the boundary at this time forbids to be valid, ascending. Where it does at time
  /// 1 the steps end before the time from which on it does, found by halving without a morph.
  /// Empty: not asked.
  std::function<std::vector<Index>(double time)> forbidden;
};

struct SubStepResult
{
  Points moved;       ///< #nodes x 3, the last valid mesh
  double reached = 0; ///< its time; 1: all of the motion
  Index attempts = 0; ///< each prepares the method for the mesh before it
  Index failures = 0; ///< of them, that inverted cells
  /// Where not all of the motion was reached: the cells that the boundary forbids right after it
  /// or, where `isForbidden` is false, those that the last attempt inverted. Ascending.
  std::vector<Index> inverted;
  bool isForbidden = false;
  EvaluateReport report; ///< of the last attempt; iterations of all
};

/// Follows the path in steps, each from the mesh that the step before left, by a method prepared on
/// it; a step that leaves inverted or degenerate cells is taken back and halved, and after two good
/// ones in a row doubled. `make`: a method with its options, not prepared yet; its setReference()
/// is given `reference`, #nodes x 3. `orientation`: #cells, of the undeformed mesh. Throws Error
/// for an undeformed mesh with inverted cells, and what prepare() throws at the first attempt.
/// Cost: an attempt's prepare() and evaluate(), at most `limits.attempts` times, of which at most
/// `limits.failures` in vain.
SubStepResult morphIncrementally(const Mesh& rest, const Points& reference,
  const NodePartition& partition, const std::vector<std::int8_t>& orientation,
  const BoundaryPath& path, const std::function<std::unique_ptr<Morpher>()>& make,
  const SubStepLimits& limits, Monitor& monitor);
}
