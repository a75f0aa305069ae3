// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/Method.h"

#include "Support/Error.h"
#include "Support/ProgressRange.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <string>

namespace morph::distributed
{
Method::~Method() = default;

void Method::prepare(const DistributedMesh& mesh, const NodePartition& partition, Monitor& monitor)
{
  const Ranks& ranks = mesh.ranks();
  this->mesh_ = &mesh;
  this->partition_ = partition;
  this->ownFree_.clear();
  std::copy_if(partition.free.begin(), partition.free.end(), std::back_inserter(this->ownFree_),
    [&](Index node) { return mesh.owns(node); });
  if (ranks.sum(static_cast<Index>(partition.prescribed.size())) == 0)
  {
    throw Error(Error::Kind::Singular, "No node is prescribed, so nothing says where the mesh "
                                       "goes. Prescribe the boundary's nodes.");
  }
  ranks.together(
    [&]
    {
      this->higherOrderNodes_.prepare(mesh.mesh(), partition);
      monitor.check();
    });
  ProgressRange whole(monitor, 0, 1);
  this->doPrepare(whole);
  monitor.progress(1);
}

EvaluateReport Method::mode(const Points& prescribed, Points& field, Monitor& monitor) const
{
  const DistributedMesh& mesh = *this->mesh_;
  const Ranks& ranks = mesh.ranks();
  Points free(static_cast<Index>(this->ownFree_.size()), 3);
  ProgressRange whole(monitor, 0, 1);
  EvaluateReport report = this->displace(prescribed, free, whole);
  std::vector<Index> notFinite;
  for (Index i = 0; i < free.rows(); ++i)
  {
    if (!free.row(i).allFinite())
    {
      notFinite.push_back(mesh.nodeId(this->ownFree_[i]));
    }
  }
  ranks.together(
    [&]
    {
      if (!notFinite.empty())
      {
        throw Error("The positions found are not finite (NaN or infinite) at node ids " +
                    listIds(notFinite) +
                    ". The motion, or the mesh, is too large to compute with: scale it down.");
      }
    });
  Points all = Points::Zero(mesh.mesh().points.rows(), 3);
  all(this->partition_.prescribed, allColumns) = prescribed;
  all(this->ownFree_, allColumns) = free;
  mesh.halo().update(ranks, all);
  if (ranks.sum(Index(!this->higherOrderNodes_.empty())) > 0)
  {
    this->higherOrderNodes_.apply(all);
    mesh.halo().update(ranks, all);
  }
  mesh.copyToDoubles(all);
  field.swap(all);
  return report;
}

EvaluateReport Method::evaluate(const Points& prescribed, Points& moved, Monitor& monitor) const
{
  const Points& rest = this->mesh_->mesh().points;
  Points all;
  const EvaluateReport report =
    this->mode(prescribed - rest(this->partition_.prescribed, allColumns), all, monitor);
  moved = rest;
  for (Index n = 0; n < rest.rows(); ++n)
  {
    for (int j = 0; j < 3; ++j)
    {
      if (all(n, j) != 0) // bit for bit where nothing moves: -0.0 + 0.0 would be 0.0
      {
        moved(n, j) += all(n, j);
      }
    }
  }
  moved(this->partition_.prescribed, allColumns) = prescribed;
  monitor.progress(1);
  return report;
}

EvaluateReport Method::applyTranspose(
  const Points& gradient, Points& prescribed, Monitor& monitor) const
{
  const DistributedMesh& mesh = *this->mesh_;
  const Ranks& ranks = mesh.ranks();
  Points all = Points::Zero(gradient.rows(), 3);
  for (Index n = 0; n < all.rows(); ++n)
  {
    if (mesh.owns(n))
    {
      all.row(n) = gradient.row(n);
    }
  }
  if (ranks.sum(Index(!this->higherOrderNodes_.empty())) > 0)
  {
    // Ghosts' rows are zero; what the owned nodes give to ghosts goes to their owners.
    this->higherOrderNodes_.applyTranspose(all);
    mesh.halo().add(ranks, all);
  }
  ProgressRange whole(monitor, 0, 1);
  const std::vector<Index>& nodes = this->partition_.prescribed;
  Points result = Points::Zero(static_cast<Index>(nodes.size()), 3);
  const EvaluateReport report =
    this->displaceTranspose(all(this->ownFree_, allColumns), result, whole);
  Points sums = Points::Zero(all.rows(), 3);
  sums(nodes, allColumns) = result;
  mesh.halo().add(ranks, sums);
  for (std::size_t k = 0; k < nodes.size(); ++k)
  {
    result.row(static_cast<Index>(k)) = sums.row(nodes[k]) + all.row(nodes[k]);
    if (!mesh.owns(nodes[k]))
    {
      result.row(static_cast<Index>(k)).setZero();
    }
  }
  prescribed.swap(result);
  monitor.progress(1);
  return report;
}

void requirePrescribedBodies(const DistributedMesh& mesh, const NodePartition& partition)
{
  const Ranks& ranks = mesh.ranks();
  const ConnectedComponents& bodies = mesh.bodies();
  std::vector<Index> held(bodies.count, 0);
  for (Index node : partition.prescribed)
  {
    if (bodies.ofNode[node] >= 0 && mesh.owns(node))
    {
      held[bodies.ofNode[node]] = 1;
    }
  }
  std::int64_t firstCell = -1;
  ranks.sum(held.data(), held.size());
  const auto bare = std::find(held.begin(), held.end(), 0);
  if (bare == held.end())
  {
    return;
  }
  const Index body = bare - held.begin();
  Index count = 0;
  for (std::size_t c = 0; c < bodies.ofCell.size(); ++c)
  {
    if (bodies.ofCell[c] == body && mesh.isGhost()[c] == 0)
    {
      const std::int64_t id = mesh.cellId(static_cast<Index>(c));
      firstCell = count == 0 ? id : std::min(firstCell, id);
      ++count;
    }
  }
  firstCell = ranks.minimum(count > 0 ? firstCell : std::numeric_limits<std::int64_t>::max());
  count = ranks.sum(count);
  throw Error(Error::Kind::Singular,
    "Body " + std::to_string(body) + " (" + std::to_string(count) + " cells, the first is cell " +
      std::to_string(firstCell) +
      ") has no prescribed node, so nothing says where it goes. Prescribe at least one of its "
      "nodes, or remove it from the grid.");
}
}
