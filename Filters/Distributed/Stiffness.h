// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/DistributedMesh.h"

#include "Morpher/CellStiffness.h"
#include "Support/Monitor.h"

#include <vector>

namespace morph::distributed
{
/// morph::stiffnessFactors() of a distributed mesh: #cells, ghosts included; empty for Uniform
/// without values on all ranks. `prescribed`: local nodes. `stiffness`: its values are those of the
/// piece's cells. For WallDistance each rank gathers the walls: 24 bytes a node. Throws Error on
/// all ranks. Collective.
std::vector<double> stiffnessFactors(const DistributedMesh& mesh,
  const std::vector<Index>& prescribed, const CellStiffness& stiffness, Monitor& monitor);
}
