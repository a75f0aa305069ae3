// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Private/Displace/BoundaryModel.h"
#include "Private/Displace/Choice.h"
#include "Private/Displace/Surroundings.h"

#include <vector>

/// What was asked of the boundary and is not met.
namespace morph::filters::Unmet
{
/// Warns of nodes that are not where they were asked to be, to rounding: those that move, at
/// `targets` (of choice.Moving), those that are held, and those of zones on surfaces that slide.
/// `choice`: as the user has it, before zones win over it.
void Warn(const BoundaryModel& model, const Choice::Result& choice, const morph::Points& targets,
  const std::vector<morph::Index>& sliding, const Surroundings::Result& result,
  Surroundings& surroundings, morph::Monitor& monitor);
}
