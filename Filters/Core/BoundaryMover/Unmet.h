// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMover/BoundaryModel.h"
#include "BoundaryMover/Choice.h"
#include "BoundaryMover/Surroundings.h"

#include <array>
#include <cstdint>
#include <vector>

namespace morph
{
/// Warns of nodes that are not where they were asked to be, to rounding: those that move, at
/// `targets` (of choice.moving), those that are held, and those of zones on surfaces that slide.
/// `choice`: as the user has it, before zones win over it.
void warnOfUnmet(const BoundaryModel& model, const Choice& choice, const Points& targets,
  const std::vector<Index>& sliding, const Surroundings::Result& result, Surroundings& surroundings,
  Monitor& monitor);

/// The nodes of the boundary at the places of nodes of other bodies, which are not tied to them.
class TouchingNodes
{
public:
  /// Warns of those that the motion parts from the others, by more than rounding: their number, the
  /// surfaces of both and the largest distance. Cost: a sort of the boundary's nodes, unless the
  /// boundary is the same as before.
  void warnOfParted(
    const BoundaryModel& model, const Surroundings::Result& result, Monitor& monitor);

private:
  std::int64_t version_ = -1; ///< BoundaryModel::motionVersion
  std::vector<std::array<Index, 2>> pairs_;
};
}
