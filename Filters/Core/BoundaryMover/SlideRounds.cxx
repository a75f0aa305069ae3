// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMover/SlideRounds.h"

#include "BoundaryMorphing/MidNodes.h"
#include "Mesh/Polyhedra.h"
#include "Support/Error.h"
#include "Support/ProgressRange.h"

#include <algorithm>
#include <map>
#include <sstream>

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

void SlideRounds::prepare(const BoundaryModel& model, const std::vector<Index>& nodes,
  const Surroundings::Result& result, Monitor& monitor)
{
  const Mesh& mesh = model.mesh;
  if (mesh.numberOfCells() == 0)
  {
    throw Error("`SlideRounds` needs the mesh's cells, and the input is a surface. Give the "
                "volume mesh to this filter, or set `SlideRounds` to 0.");
  }
  requireKnownCells(hasPolyhedra(mesh));
  std::vector<Index> prescribed;
  for (const Index node : InnerNodes::prescribed(model, result))
  {
    if (!std::binary_search(nodes.begin(), nodes.end(), node))
    {
      prescribed.push_back(node);
    }
  }
  if (!this->method_ || this->methodVersion_ != model.inputVersion || nodes != this->sliding_ ||
      prescribed != this->prescribed_)
  {
    this->method_ = nullptr; // in case it throws
    auto method = std::make_unique<SlidingWarp>();
    QuietRange silent(monitor, 0, 1);
    method->prepare(mesh, partitionNodes(mesh, prescribed), silent);
    this->method_ = std::move(method);
    this->methodVersion_ = model.inputVersion;
    this->sliding_ = nodes;
    this->prescribed_ = prescribed;
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
  const auto along = [&](const std::vector<Index>& numbered) -> NodeSliding::Surfaces
  {
    const auto of = [&](Index i) { return sliding.find(numbered[static_cast<std::size_t>(i)]); };
    return { [&model, &shapes, of](Index i, const Row& x)
      { return directionsAt(model, of(i)->second, shapes, x); },
      [&model, &shapes, of](Index i, const Row& x)
      { return shapes.slid(model, of(i)->second, of(i)->first, x); } };
  };
  const Points before = result.moved;
  if (pieces)
  {
    requireKnownCells(pieces->anywhere(hasPolyhedra(pieces->piece())));
    Points places = before(nodes, allColumns);
    this->rounds_ = pieces->slide(
      inner.prescribedOnRanks(model, result, nodes), nodes, along(nodes), limits, places, monitor);
    result.moved(nodes, allColumns) = places;
  }
  else
  {
    this->prepare(model, nodes, result, monitor);
    this->rounds_ = this->method_->slide(nodes, along(nodes), limits, result.moved, monitor);
  }
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
