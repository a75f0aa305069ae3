// SPDX-License-Identifier: BSD-3-Clause
#include "ClassifiedShape.h"

using namespace morph;

namespace shapes
{
ClassifiedShape::ClassifiedShape(const Mesh& m)
  : mesh(m)
{
  Monitor monitor;
  this->faces = boundaryFaces(this->mesh, monitor);
  this->geometry = classify(this->mesh, this->faces, {}, monitor);
}

BoundaryMotion ClassifiedShape::withEdgesMoved(const std::function<Row(const Row&)>& map) const
{
  std::vector<Index> ids;
  for (Index node : this->faces.nodes)
  {
    if (this->geometry.dimension[node] < 2)
    {
      ids.push_back(node);
    }
  }
  Points targets(static_cast<Index>(ids.size()), 3);
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    targets.row(static_cast<Index>(i)) = map(this->mesh.points.row(ids[i]));
  }
  return beginMotion(this->mesh, this->faces, this->geometry, ids, targets);
}
}
