// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMover/BoundaryModel.h"
#include "BoundaryMover/Choice.h"
#include "BoundaryMover/Surroundings.h"

#include <vector>

namespace morph
{
/// Warns of nodes that are not where they were asked to be, to rounding: those that move, at
/// `targets` (of choice.moving), those that are held, and those of zones on surfaces that slide.
/// `choice`: as the user has it, before zones win over it.
void warnOfUnmet(const BoundaryModel& model, const Choice& choice, const Points& targets,
  const std::vector<Index>& sliding, const Surroundings::Result& result, Surroundings& surroundings,
  Monitor& monitor);
}
