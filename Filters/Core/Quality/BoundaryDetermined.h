// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/NodePartition.h"
#include "Support/Communicator.h"
#include "Support/Monitor.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// Returns the cells, ascending, that the prescribed positions invert for any position of the free
/// nodes. The proof covers two cases, the second in exact arithmetic (ExactPredicates.h):
/// - A corner and its neighbors along the edges are prescribed and span no positive volume.
/// - No position of one free node makes the cell's corners positive that have no other free node.
/// `points`: #nodes x 3, read only at the prescribed nodes. `orientation`: #cells, see cellSigns()
/// in Topology.h. Cost: one pass over the cells.
std::vector<Index> boundaryDeterminedInversions(const Mesh& mesh, const NodePartition& partition,
  const std::vector<std::int8_t>& orientation, const Points& points);

/// Of these cells, those that are neither inverted nor flat (InvertedBefore::Flat) at `rest`,
/// #nodes x 3. Cost: a measureQuality() more, where there are any.
std::vector<Index> inversionsByBoundaryMotion(const Mesh& mesh, const NodePartition& partition,
  const std::vector<std::int8_t>& orientation, const Points& rest, const Points& points,
  Monitor& monitor);

/// Warns of cells that the boundary itself inverts, if there are some, by their ids.
void warnOfDetermined(const std::vector<Index>& ids, Monitor& monitor);

/// A free node without a position where all cells around it are valid. Each of these cells alone
/// leaves it a position.
struct NodeWithoutPlace
{
  Index node;
  /// ascending; at least one is inverted for any position of the free nodes
  std::vector<Index> cells;
};

/// Returns such nodes, ascending; arguments as above. Cost: a pass over the cells, and 10
/// microseconds a free node next to prescribed ones. On several `processes` each gets those of the
/// nodes that count here. Collective.
std::vector<NodeWithoutPlace> nodesWithoutPlace(const Mesh& mesh, const NodePartition& partition,
  const std::vector<std::int8_t>& orientation, const Points& points, Monitor& monitor,
  const Communicator& processes = Communicator::alone());
}
