// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMorphing/BoundaryProjection.h"

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

/// Moves mid-side and face nodes that their surface moved (state OnSurface) with their corners: by
/// meanBetween() of the shifts of these since `before` (#nodes x 3, moved positions), and onto the
/// `target`, if not null. `normals`: of surfaceNodeNormals(), read with a target alone.
void carryMidNodes(const BoundaryFaces& faces, const Classification& geometry,
  const ProjectionTarget* target, const Points& normals, const Points& before,
  BoundaryMotion& motion);
}
