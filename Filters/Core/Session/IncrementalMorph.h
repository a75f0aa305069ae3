// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Morpher/Morpher.h"
#include "Quality/InvertedBefore.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace morph
{
/// The prescribed positions, #prescribed x 3, at a time from 0 (undeformed) to 1.
using BoundaryPath = std::function<Points(double time)>;

/// Returns the straight path of the prescribed nodes from `rest` to `target`, #prescribed x 3.
BoundaryPath straightPath(const Points& rest, const NodePartition& partition, const Points& target);

struct SubStepLimits
{
  double first = 0.5;      ///< the first step tried, of the whole motion
  double least = 1. / 256; ///< no step is shorter
  Index attempts = 64;     ///< includes failed ones
  Index failures = 16;     ///< maximum number of failed attempts, which take a method longest
  /// Returns the cells that the boundary forbids to be valid at a time, ascending; empty: not
  /// tested. If it forbids cells at time 1, the steps end before the time when it starts to.
  /// Bisection finds this time without a morph.
  std::function<std::vector<Index>(double time)> forbidden;
};

struct SubStepResult
{
  Points moved;       ///< #nodes x 3, the last valid mesh
  double reached = 0; ///< time of the last valid mesh; 1 is the whole motion
  Index attempts = 0; ///< each prepares the method for the last valid mesh
  Index failures = 0; ///< attempts that inverted cells
  /// If the motion was not completed: the cells that the boundary forbids right after it,
  /// ascending. If `isForbidden` is false: the cells that the last attempt inverted.
  std::vector<Index> inverted;
  bool isForbidden = false;
  EvaluateReport report; ///< of the last attempt; iterations are the sum of all
};

/// Follows the path up to time 1 by steps, with a method prepared on the last valid mesh. A step
/// that leaves inverted cells is undone and halved; after two good steps the length doubles.
/// `make`: creates the method with its options, not prepared; it gets setReference(`reference`),
/// #nodes x 3. `orientation`: #cells, of the undeformed mesh. Cells of `before` that are no worse
/// do not count as inverted. Throws Error for an undeformed mesh with other inverted cells, and
/// errors of prepare() at the first attempt. Cost: prepare() and evaluate() for each of at most
/// `limits.attempts`, of which at most `limits.failures` fail. `processes`: see Morpher::prepare();
/// cells are named by their numbers in the whole mesh then.
SubStepResult morphIncrementally(const Mesh& rest, const Points& reference,
  const NodePartition& partition, const std::vector<std::int8_t>& orientation,
  const InvertedBefore& before, const BoundaryPath& path,
  const std::function<std::unique_ptr<Morpher>()>& make, const SubStepLimits& limits,
  Monitor& monitor, const std::shared_ptr<const Communicator>& processes = nullptr);
}
