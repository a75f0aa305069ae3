// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods/SlidingWarp.h"

#include "LinearMethods/FemWarpSystem.h"
#include "Mesh/Topology.h"
#include "Mesh/UnknownOrdering.h"
#include "Support/Error.h"

#include <utility>

namespace morph
{
void SlidingWarp::prepare(const Mesh& rest, const std::vector<Index>& prescribed,
  const std::vector<Index>& sliding, Monitor& monitor)
{
  const NodePartition partition = partitionNodes(rest, prescribed);
  requirePrescribedBodies(rest, connectedComponents(rest, monitor), partition);
  this->points_ = rest.points;
  this->prescribed_ = partition.prescribed;
  this->rows_ = unknownOrdering(rest, partition.free);
  FemWarpSystem system = femWarpSystem(rest, this->rows_, partition.prescribed, {}, monitor);
  this->coupling_.swap(system.coupling);
  LinearEquations equations;
  equations.matrix.swap(system.interior);
  equations.coordinates = rest.points(this->rows_, allColumns);
  try
  {
    this->solver_.prepare(std::move(equations), monitor);
  }
  catch (const SingularRows& error)
  {
    std::vector<Index> nodes;
    for (const Index row : error.rows())
    {
      nodes.push_back(this->rows_[row]);
    }
    throw Error(Error::Kind::Singular,
      "Every cell around node ids " + listIds(nodes) +
        " has zero volume, so nothing says where they slide. Repair the cells.");
  }
  std::vector<int> rowOfNode(rest.numberOfNodes(), -1);
  for (std::size_t i = 0; i < this->rows_.size(); ++i)
  {
    rowOfNode[this->rows_[i]] = static_cast<int>(i);
  }
  this->sliding_.clear();
  this->slidingRow_.clear();
  for (const Index node : sliding)
  {
    if (rowOfNode[node] >= 0)
    {
      this->sliding_.push_back(node);
      this->slidingRow_.push_back(rowOfNode[node]);
    }
  }
}

std::vector<SlidingWarp::Round> SlidingWarp::slide(
  const Surfaces& surfaces, const Limits& limits, Points& moved, Monitor& monitor) const
{
  const auto count = static_cast<Index>(this->sliding_.size());
  if (count == 0 || limits.rounds <= 0)
  {
    return {};
  }
  const NodeSliding::Nodes nodes = { this->slidingRow_, this->points_(this->sliding_, allColumns) };
  const Points prescribed =
    moved(this->prescribed_, allColumns) - this->points_(this->prescribed_, allColumns);
  const Points b = -(this->coupling_ * prescribed);
  Points x = Points::Zero(static_cast<Index>(this->rows_.size()), 3);
  for (Index i = 0; i < count; ++i)
  {
    x.row(this->slidingRow_[i]) = moved.row(this->sliding_[i]) - nodes.rest.row(i);
  }
  std::vector<Round> result =
    NodeSliding(this->solver_, b, nodes, surfaces).run(limits, x, monitor);
  for (Index i = 0; !result.empty() && i < count; ++i)
  {
    const Row displacement = x.row(this->slidingRow_[i]);
    if (displacement != moved.row(this->sliding_[i]) - nodes.rest.row(i))
    {
      // Adding the displacement has rounded; the nearest point of a plane is on it.
      moved.row(this->sliding_[i]) = surfaces.closest(i, nodes.rest.row(i) + displacement);
    }
  }
  return result;
}
}
