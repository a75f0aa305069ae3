// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Topology.h"
#include "Support/Communicator.h"

#include <vector>

namespace morph
{
/// The k-ring neighborhood of a set of cells.
struct KRing
{
  std::vector<Index> nodes; ///< free corners of the seeds and of the first k rings, ascending
  std::vector<Index> cells; ///< all cells with such a corner, ascending
};

/// `seeds`: cell ids; `rings`: k; `around`: nodeToCells(mesh); `free`: node ids, ascending. Cost:
/// passes over nodes and cells, and the neighborhood. On several processes the seeds are those of
/// all, and the result has the nodes and cells of this one.
KRing kRingOfCells(const Mesh& mesh, const Adjacency& around, const std::vector<Index>& free,
  const std::vector<Index>& seeds, int rings,
  const Communicator& communicator = Communicator::alone());
}
