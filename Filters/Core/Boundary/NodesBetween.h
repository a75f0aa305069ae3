// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Topology.h"

#include <Eigen/Core>

#include <vector>

namespace morph
{
/// The weights of the corners that a mid-side or face node is between. They sum to 1, and their
/// mean of the corners in `rest` (#nodes x 3) is the node's nearest place in the line or plane of
/// these: half of both at the middle of an edge, 1/4 and 3/4 at a quarter point. Of four corners,
/// the weights are as equal as that allows. `node`: a number in faces.nodes. None for a corner.
Eigen::VectorXd weightsBetween(const BoundaryFaces& faces, Index node, const Points& rest);

/// The mean of rows(corner) with these weights; zero for a corner.
template <typename Rows>
Eigen::RowVector3d meanBetween(
  const BoundaryFaces& faces, Index node, const Points& rest, const Rows& rows)
{
  const Eigen::VectorXd weights = weightsBetween(faces, node, rest);
  Eigen::RowVector3d mean = Eigen::RowVector3d::Zero();
  for (Index i = 0; i < weights.size(); ++i)
  {
    mean += weights[i] * rows(faces.between.begin(node)[i]);
  }
  return mean;
}

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
