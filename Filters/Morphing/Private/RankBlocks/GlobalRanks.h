// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/Ranks.h"

#include <string>
#include <vector>

namespace morph::filters
{
/// The processes of VTK's global controller. Throws morph::Error unless they communicate by MPI.
morph::distributed::Ranks GlobalRanks();

/// The different texts of all processes, sorted. Collective.
std::vector<std::string> GatherTexts(
  const morph::distributed::Ranks& ranks, const std::vector<std::string>& mine);
}
