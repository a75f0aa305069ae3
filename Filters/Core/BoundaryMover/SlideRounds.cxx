// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMover/SlideRounds.h"

#include "BoundaryMorphing/MidNodes.h"
#include "Mesh/Polyhedra.h"
#include "Support/Error.h"
#include "Support/ProgressRange.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <sstream>
#include <utility>

namespace morph
{
namespace
{
using Row = Eigen::RowVector3d;
using Surfaces = std::vector<Index>;

/// Of the angle between two surfaces: below it they are one where a node slides.
constexpr double LeastSine = 1e-3;

/// The surfaces of each node that slides, by node id.
std::map<Index, Surfaces> slidingNodes(const BoundaryModel& model, const std::vector<Index>& held,
  const Surfaces& sliding, const Surroundings::Result& result)
{
  std::map<Index, Surfaces> nodes;
  const auto& surfaces = model.geometry.surfaces;
  for (const Index s : sliding)
  {
    for (const Index node : surfaces[s].nodes)
    {
      const signed char role = result.roles[node];
      if (role == Surroundings::Stays || role == Surroundings::Follows ||
          role == Surroundings::IsHeld) // vertices, and surfaces that nothing touches
      {
        nodes[node].push_back(s);
      }
    }
  }
  for (std::size_t s = 0; s < surfaces.size(); ++s)
  {
    if (!std::binary_search(sliding.begin(), sliding.end(), static_cast<Index>(s)))
    {
      for (const Index node : surfaces[s].nodes)
      {
        nodes.erase(node);
      }
    }
  }
  for (const Index node : held)
  {
    nodes.erase(node);
  }
  return nodes;
}

/// The projection onto the directions along all surfaces at `x`.
Eigen::Matrix3d directionsAt(
  const BoundaryModel& model, const Surfaces& surfaces, Surroundings& shapes, const Row& x)
{
  Eigen::Matrix3d free = Eigen::Matrix3d::Identity();
  for (const Index s : surfaces)
  {
    const Eigen::Vector3d across = free * shapes.shapeOf(model, s).normal(x).transpose();
    if (across.norm() > LeastSine)
    {
      const Eigen::Vector3d unit = across.normalized();
      free -= unit * unit.transpose();
    }
  }
  // Three surfaces that meet leave rounding.
  return free.trace() < 0.5 ? Eigen::Matrix3d(Eigen::Matrix3d::Zero()) : free;
}

/// Moves mid-side and face nodes that slide by what their corners have moved since `before`.
void moveBetween(const BoundaryModel& model, const std::map<Index, Surfaces>& sliding,
  const Points& before, Surroundings& shapes, Points& moved)
{
  const BoundaryFaces& faces = model.faces;
  for (std::size_t i = 0; i < faces.nodes.size(); ++i)
  {
    const auto k = static_cast<Index>(i);
    const auto found = sliding.find(faces.nodes[i]);
    if (found == sliding.end())
    {
      continue;
    }
    const Row shift = meanBetween(faces, k, model.points(),
      [&](Index corner) { return Row(moved.row(corner) - before.row(corner)); });
    if (!shift.isZero(0))
    {
      moved.row(found->first) =
        shapes.slid(model, found->second, found->first, before.row(found->first) + shift);
    }
  }
}

void requireKnownCells(bool hasPolyhedra)
{
  if (hasPolyhedra)
  {
    throw Error("`SlideRounds` does not know polyhedra, and the mesh has some, or hexahedra that "
                "name a node more than once. Set it to 0.");
  }
}
}

void SlideRounds::prepare(const Mesh& mesh, const std::shared_ptr<const Communicator>& processes,
  std::int64_t version, const std::vector<Index>& sliding, const std::vector<Index>& prescribed,
  Monitor& monitor)
{
  const Communicator& all = processes ? *processes : Communicator::alone();
  requireKnownCells(!all.all(!hasPolyhedra(mesh)));
  if (!all.all(this->method_ && this->methodVersion_ == version &&
               &this->method_->processes() == &all && sliding == this->sliding_ &&
               this->method_->partition().prescribed == prescribed))
  {
    this->method_ = nullptr; // in case it throws
    auto method = std::make_unique<SlidingWarp>();
    QuietRange silent(monitor, 0, 1);
    NodePartition partition;
    all.together([&] { partition = partitionNodes(mesh, prescribed); });
    method->prepare(mesh, partition, silent, processes);
    this->method_ = std::move(method);
    this->methodVersion_ = version;
    this->sliding_ = sliding;
  }
}

void SlideRounds::run(const BoundaryModel& model, const std::vector<Index>& held,
  const std::vector<Index>& surfaces, const SlidingWarp::Limits& limits, Surroundings& shapes,
  const InnerPieces* pieces, const InnerNodes& inner, Surroundings::Result& result,
  Monitor& monitor)
{
  this->rounds_.clear();
  if (surfaces.empty())
  {
    monitor.warn("`SlideRounds` has no effect: no surface is named that slides.");
    return;
  }
  const std::map<Index, Surfaces> sliding = slidingNodes(model, held, surfaces, result);
  std::vector<Index> nodes;
  for (const auto& [node, on] : sliding)
  {
    nodes.push_back(node);
  }
  const Points before = result.moved;
  const Mesh& mesh = pieces ? pieces->mesh() : model.mesh;
  if (model.mesh.numberOfCells() == 0)
  {
    throw Error("`SlideRounds` needs the mesh's cells, and the input is a surface. Give the "
                "volume mesh to this filter, or set `SlideRounds` to 0.");
  }
  const std::shared_ptr<const Communicator> others = pieces ? pieces->processes() : nullptr;
  Points places = before;
  std::vector<Index> prescribed;
  if (pieces)
  {
    prescribed = pieces->place(inner.prescribedOnRanks(model, result, nodes), places);
  }
  else
  {
    const std::vector<Index> given = InnerNodes::prescribed(model, result);
    std::set_difference(
      given.begin(), given.end(), nodes.begin(), nodes.end(), std::back_inserter(prescribed));
  }
  std::vector<std::pair<Index, Index>> here; // nodes of the mesh, and of the boundary
  for (const Index node : nodes)
  {
    if (const Index own = pieces ? pieces->nodeOf(node) : node; own >= 0)
    {
      here.emplace_back(own, node);
      places.row(own) = before.row(node);
    }
  }
  std::sort(here.begin(), here.end());
  std::vector<Index> own;
  for (const auto& [node, ofBoundary] : here)
  {
    own.push_back(node);
  }
  const auto of = [&](Index i) { return sliding.find(here[static_cast<std::size_t>(i)].second); };
  const NodeSliding::Surfaces along = { [&](Index i, const Row& x)
    { return directionsAt(model, of(i)->second, shapes, x); },
    [&](Index i, const Row& x) { return shapes.slid(model, of(i)->second, of(i)->first, x); } };
  this->prepare(mesh, others, model.inputVersion, own, prescribed, monitor);
  this->rounds_ = this->method_->slide(own, along, limits, places, monitor);
  // In the order of the nodes' ids, as `nodes` are.
  result.moved(nodes, allColumns) = this->method_->processes().gather(places, own);
  moveBetween(model, sliding, before, shapes, result.moved);
  for (const Index node : nodes)
  {
    if (result.moved.row(node) != before.row(node))
    {
      result.roles[node] = Surroundings::Follows;
    }
  }
}

std::string SlideRounds::report(double size) const
{
  std::ostringstream text;
  text.precision(3);
  for (std::size_t i = 0; i < this->rounds_.size(); ++i)
  {
    text << (i > 0 ? "; " : "") << "round " << i + 1 << ": moved by "
         << this->rounds_[i].change / size << " of the size, force left " << this->rounds_[i].force;
  }
  return this->rounds_.empty() ? "None" : text.str();
}
}
