// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Displace/LocalBoundary.h"

namespace morph::filters
{
namespace
{
using morph::Index;

/// The values of these nodes.
template <typename Value>
std::vector<Value> some(const std::vector<Value>& all, const std::vector<Index>& nodes)
{
  std::vector<Value> values;
  values.reserve(nodes.size());
  for (const Index node : nodes)
  {
    values.push_back(all[node]);
  }
  return values;
}
}

void LocalBoundary::Update(const BoundaryModel& model)
{
  if (this->Version == model.MotionVersion())
  {
    return;
  }
  this->Version = -1; // in case there is not enough memory
  this->NodeOf = model.Faces().nodes;
  this->Number.assign(model.Points().rows(), -1);
  for (std::size_t i = 0; i < this->NodeOf.size(); ++i)
  {
    this->Number[this->NodeOf[i]] = static_cast<Index>(i);
  }
  const auto renumber = [this](std::vector<Index>& nodes) { nodes = this->NumbersOf(nodes); };
  this->Positions = model.Points()(this->NodeOf, morph::allColumns);
  this->Bodies = some(model.BodyOfNode(), this->NodeOf);
  this->Polygons = model.Faces();
  renumber(this->Polygons.nodes);
  renumber(this->Polygons.connectivity);
  renumber(this->Polygons.between.values);

  this->Entities = model.Geometry();
  this->Entities.dimension = some(model.Geometry().dimension, this->NodeOf);
  this->Entities.entity = some(model.Geometry().entity, this->NodeOf);
  this->Entities.parameter = some(model.Geometry().parameter, this->NodeOf);
  for (morph::GeometryVertex& vertex : this->Entities.vertices)
  {
    vertex.node = this->Number[vertex.node];
  }
  for (morph::GeometryCurve& curve : this->Entities.curves)
  {
    renumber(curve.nodes);
  }
  for (morph::GeometrySurface& surface : this->Entities.surfaces)
  {
    renumber(surface.nodes);
  }
  for (auto& ends : this->Entities.edges.nodes)
  {
    ends = { this->Number[ends[0]], this->Number[ends[1]] };
  }
  this->Version = model.MotionVersion();
}

std::vector<Index> LocalBoundary::NumbersOf(const std::vector<Index>& nodes) const
{
  return some(this->Number, nodes);
}
}
