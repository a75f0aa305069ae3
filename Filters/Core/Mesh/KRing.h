// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Topology.h"

#include <vector>

namespace morph
{
/// Cells with rings of cells round them, for work on a part of a mesh.
struct CellPatch
{
  std::vector<Index> nodes; ///< corners of `inner`, those that are free, ascending
  std::vector<Index> cells; ///< all that have a corner of `inner`, ascending
};

/// `seeds`: cell ids; inner are they and `rings` rings round them. `around`: nodeToCells(); `free`: node ids, ascending. Cost: passes
/// over the nodes and the patch.
CellPatch cellPatch(const Mesh& mesh, const Adjacency& around, const std::vector<Index>& free,
  const std::vector<Index>& seeds, int rings);
}
