// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMorphing/MidNodes.h"

#include <algorithm>

namespace morph
{
std::vector<Index> carryMidNodes(const BoundaryFaces& faces, const Classification& geometry,
  const ProjectionTarget* target, const Points& normals, const Points& before,
  BoundaryMotion& motion)
{
  using Row = ProjectionTarget::Row;
  const Points shift = motion.moved() - before;
  std::vector<Index> moved;
  for (std::size_t i = 0; i < faces.nodes.size(); ++i)
  {
    const Index k = static_cast<Index>(i), node = faces.nodes[i];
    const Index *first = faces.between.begin(k), *last = faces.between.end(k);
    Row mean = Row::Zero();
    std::for_each(first, last,
      [&](Index corner) { mean += shift.row(corner) / static_cast<double>(last - first); });
    if (motion.state[node] != BoundaryMotion::OnSurface || mean.isZero(0))
    {
      continue;
    }
    const Index surface = geometry.entity[node];
    Row to = before.row(node) + mean;
    if (!target || !target->holds(surface) ||
        target->closestOnSurface(surface, Row(to), normals.row(node), to))
    {
      motion.displacement.row(node) = to - motion.rest.row(node);
      moved.push_back(node);
    }
  }
  return moved;
}
}
