// SPDX-License-Identifier: BSD-3-Clause
#include "ClassifiedShape.h"

using namespace morph;

namespace shapes
{
ClassifiedShape::ClassifiedShape(const Mesh& m, const ClassificationOptions& options)
  : mesh(m)
{
  Monitor monitor;
  this->faces = boundaryFaces(this->mesh, monitor);
  this->geometry = classify(this->mesh, this->faces, options, monitor);
}

std::vector<Index> ClassifiedShape::upTo(int highest) const
{
  std::vector<Index> ids;
  for (Index node : this->faces.nodes)
  {
    if (this->geometry.dimension[node] <= highest)
    {
      ids.push_back(node);
    }
  }
  return ids;
}

BoundaryMotion ClassifiedShape::begin(
  const std::vector<Index>& ids, const std::function<Row(const Row&)>& map) const
{
  Points targets(static_cast<Index>(ids.size()), 3);
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    targets.row(static_cast<Index>(i)) = map(this->mesh.points.row(ids[i]));
  }
  return beginMotion(this->mesh, this->faces, this->geometry, ids, targets);
}

BoundaryMotion ClassifiedShape::withEdgesMoved(const std::function<Row(const Row&)>& map) const
{
  return this->begin(this->upTo(1), map);
}
}
