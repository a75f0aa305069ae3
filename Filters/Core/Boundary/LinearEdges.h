// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Topology.h"

#include <vector>

namespace morph
{
/// Returns the nodes of quadratic cells on the boundary that are between the corners of an edge
/// that linear cells have, too, by their numbers in faces.nodes, ascending. Cost: a pass over the
/// cells of a mesh with quadratic ones.
std::vector<Index> nodesOnLinearEdges(const Mesh& mesh, const BoundaryFaces& faces);

/// Of these nodes those that a motion takes off the edge of the linear cell, which is straight.
struct Parting
{
  std::vector<Index> nodes; ///< ids, ascending
  double largest = 0;       ///< distance
};
/// `onLinearEdges`: see above; `rest`, `moved`: #nodes x 3. Distances up to 1e-6 of `size` do not
/// count.
Parting partingNodes(const std::vector<Index>& onLinearEdges, const BoundaryFaces& faces,
  const Points& rest, const Points& moved, double size);
}
