// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMover/LocalBoundary.h"

namespace morph
{
namespace
{
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

void LocalBoundary::update(const BoundaryModel& model)
{
  if (this->version_ == model.motionVersion)
  {
    return;
  }
  this->version_ = -1; // in case there is not enough memory
  this->nodes_ = model.faces.nodes;
  this->number_.assign(model.points().rows(), -1);
  for (std::size_t i = 0; i < this->nodes_.size(); ++i)
  {
    this->number_[this->nodes_[i]] = static_cast<Index>(i);
  }
  const auto renumber = [this](std::vector<Index>& nodes) { nodes = this->numbersOf(nodes); };
  this->points_ = model.points()(this->nodes_, allColumns);
  this->bodyOfNode_ = some(model.bodyOfNode, this->nodes_);
  this->faces_ = model.faces;
  renumber(this->faces_.nodes);
  renumber(this->faces_.connectivity);
  renumber(this->faces_.between.values);

  this->geometry_ = model.geometry;
  this->geometry_.dimension = some(model.geometry.dimension, this->nodes_);
  this->geometry_.entity = some(model.geometry.entity, this->nodes_);
  this->geometry_.parameter = some(model.geometry.parameter, this->nodes_);
  for (GeometryVertex& vertex : this->geometry_.vertices)
  {
    vertex.node = this->number_[vertex.node];
  }
  for (GeometryCurve& curve : this->geometry_.curves)
  {
    renumber(curve.nodes);
  }
  for (GeometrySurface& surface : this->geometry_.surfaces)
  {
    renumber(surface.nodes);
  }
  for (auto& ends : this->geometry_.edges.nodes)
  {
    ends = { this->number_[ends[0]], this->number_[ends[1]] };
  }
  this->version_ = model.motionVersion;
}

std::vector<Index> LocalBoundary::numbersOf(const std::vector<Index>& nodes) const
{
  return some(this->number_, nodes);
}
}
