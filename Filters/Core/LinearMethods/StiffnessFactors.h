// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Morpher/CellStiffness.h"
#include "Support/Communicator.h"
#include "Support/Monitor.h"

#include <vector>

namespace morph
{
/// Returns the stiffness of each cell, #cells, relative to the stiffest volume cell and at
/// least 1e-10; 1 for cells below dimension 3. Empty for Uniform without values.
/// `prescribed`: the walls where `stiffness` names none. Throws Error for an exponent outside [0,
/// 4], values that are not positive, finite and one a cell, and walls that are no nodes. Cost: a
/// pass over the cells; for WallDistance also a k-d tree of the walls, of which each process gets
/// all: 24 bytes a node. `processes`: of the mesh; values are then those of a process's own cells.
/// Collective.
std::vector<double> stiffnessFactors(const Mesh& mesh, const std::vector<Index>& prescribed,
  const CellStiffness& stiffness, Monitor& monitor,
  const Communicator& processes = Communicator::alone());
}
