// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMorphing/MidNodes.h"

namespace morph
{
void carryMidNodes(const BoundaryFaces& faces, const Classification& geometry,
  const ProjectionTarget* target, const Points& normals, const Points& before,
  BoundaryMotion& motion)
{
  using Row = ProjectionTarget::Row;
  const Points shift = motion.moved() - before;
  for (std::size_t i = 0; i < faces.nodes.size(); ++i)
  {
    const Index k = static_cast<Index>(i), node = faces.nodes[i];
    if (motion.state[node] != BoundaryMotion::OnSurface)
    {
      continue;
    }
    const Row mean =
      meanBetween(faces, k, motion.rest, [&](Index corner) { return Row(shift.row(corner)); });
    if (mean.isZero(0))
    {
      continue;
    }
    const Index surface = geometry.entity[node];
    Row to = before.row(node) + mean;
    if (!target || !target->holds(surface) ||
        target->closestOnSurface(surface, Row(to), normals.row(node), to))
    {
      motion.displacement.row(node) = to - motion.rest.row(node);
    }
  }
}
}
