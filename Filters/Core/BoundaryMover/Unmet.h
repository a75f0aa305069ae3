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

/// Nodes of the boundary at the places of others: of the other side of a baffle, whose body is the
/// same, or of other bodies, which are not tied to them.
class TouchingNodes
{
public:
  /// Finds them, unless the boundary is the same as before. Cost: a sort of the boundary's nodes.
  void find(const BoundaryModel& model);
  /// Lets the other sides of what moves go along, but for nodes that are held, free or on a surface
  /// that slides or is free. Returns whether there are some.
  bool addOtherSides(const BoundaryModel& model, const Surroundings::Options& rest, Choice& choice,
    Points& targets) const;
  /// Warns of nodes that the motion parts from those of other bodies, by more than rounding: their
  /// number, the surfaces of both and the largest distance.
  void warnOfParted(
    const BoundaryModel& model, const Surroundings::Result& result, Monitor& monitor) const;

private:
  std::int64_t version_ = -1;                       ///< BoundaryModel::motionVersion
  std::vector<std::array<Index, 2>> pairs_, sides_; ///< of two bodies, and of one
};
}
