// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Topology.h"

#include <vector>

namespace morph
{
/// The k-ring neighborhood of a set of cells, for work on a part of a mesh.
struct KRing
{
  std::vector<Index> nodes; ///< free corners of the seeds and of the rings, ascending
  std::vector<Index> cells; ///< all cells with such a corner, ascending
};

/// `seeds`: cell ids, with `rings` rings of cells round them. `around`: nodeToCells(); `free`: node
/// ids, ascending. Cost: passes over the nodes and the patch.
KRing kRingOfCells(const Mesh& mesh, const Adjacency& around, const std::vector<Index>& free,
  const std::vector<Index>& seeds, int rings);
}
