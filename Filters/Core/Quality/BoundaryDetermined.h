// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/NodePartition.h"
#include "Support/Monitor.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// Cells that the prescribed positions invert whatever the free nodes do. Either a corner's four
/// nodes, it and its neighbors along the edges, are all prescribed and span no positive volume; or
/// no place of one free node makes all corners of the cell positive of which it is the only free
/// node (CommonPoint.h: proved, over exact numbers). Ids, ascending. `points`: #nodes x 3, read at
/// the prescribed nodes alone. `orientation`: #cells, see Topology's cellSigns(). Cost: one pass
/// over the cells.
std::vector<Index> boundaryDeterminedInversions(const Mesh& mesh, const NodePartition& partition,
  const std::vector<std::int8_t>& orientation, const Points& points);

/// A free node that has no place where all cells round it are valid, though each of them alone
/// leaves it one.
struct NodeWithoutPlace
{
  Index node;
  /// ascending; at least one of them is inverted wherever the free nodes are
  std::vector<Index> cells;
};

/// By node, ascending. Parameters as above. Cost: a pass over the cells, and 10 microseconds a free
/// node next to prescribed ones.
std::vector<NodeWithoutPlace> nodesWithoutPlace(const Mesh& mesh, const NodePartition& partition,
  const std::vector<std::int8_t>& orientation, const Points& points, Monitor& monitor);
}
