// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMover/SlideRounds.h"

#include "Boundary/NodesBetween.h"
#include "Mesh/HangingNodes.h"
#include "Morpher/PolyhedralMorpher.h"
#include "Support/Error.h"
#include "Support/Monitor.h"

#include <algorithm>
#include <functional>
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
      moved.row(found->first) = shapes.slid(
        model, found->second, model.points().row(found->first), before.row(found->first) + shift);
    }
  }
}

/// Where a node that the method slides is undeformed, and its surfaces.
struct Slide
{
  Row rest;
  Surfaces on;
};

/// Returns the centers of outer faces among nodes of the pieces.
std::vector<Index> outerCenters(
  const CellPieces& pieces, std::vector<Index> nodes, Monitor& monitor)
{
  Points isOuter = Points::Zero(pieces.mesh().numberOfNodes(), 3);
  pieces.processes()->together(
    [&] { isOuter(facesOfOneCell(pieces.mesh(), monitor).nodes, 0).setOnes(); });
  pieces.processes()->update(isOuter); // of the process that has all cells around a node
  nodes.erase(
    std::remove_if(nodes.begin(), nodes.end(), [&](Index node) { return isOuter(node, 0) == 0; }),
    nodes.end());
  return nodes;
}

/// Adds those centers of faces that have all nodes on one of the surfaces. `marks`: 1 at the nodes
/// of a surface, else 0.
void addCenters(const CellPieces& pieces, const std::vector<Index>& centers,
  const Surfaces& surfaces, const std::function<Points(Index surface)>& marks,
  std::map<Index, Slide>& slides)
{
  for (const Index s : surfaces)
  {
    const Points isOn = pieces.extend(marks(s));
    for (const Index center : centers)
    {
      if (isOn(center, 0) > 1 - 1e-9) // a mean
      {
        // The sliding nodes themselves are there already.
        slides.try_emplace(center, Slide{ pieces.mesh().points.row(center), { s } });
      }
    }
  }
}
}

const Communicator& SlideRounds::Volume::all() const
{
  return this->processes ? *this->processes : Communicator::alone();
}

NodePartition SlideRounds::Volume::partition(const std::vector<Index>& prescribed) const
{
  return this->hanging.extend(
    partitionNodes(this->mesh, this->hanging, this->hanging.without(prescribed)));
}

void SlideRounds::prepare(const Volume& volume, std::int64_t version,
  const std::vector<Index>& sliding, const std::vector<Index>& prescribed, Monitor& monitor)
{
  const Communicator& all = volume.all();
  if (all.all(this->method_ && this->methodVersion_ == version &&
              this->processes_ == volume.processes && sliding == this->sliding_ &&
              prescribed == this->prescribed_))
  {
    return;
  }
  this->method_ = nullptr; // in case it throws
  QuietRange silent(monitor, 0, 1);
  NodePartition partition;
  all.together([&] { partition = volume.partition(prescribed); });
  auto method = std::make_unique<SlidingWarp>();
  if (volume.needsPieces)
  {
    this->pieces_ = cutCells(volume.mesh, volume.hanging, all, 1, silent);
    const NodePartition ofPieces = this->pieces_->extend(partition);
    method->prepare(this->pieces_->mesh(), ofPieces, silent, this->pieces_->processes());
    std::vector<Index> given, centers;
    std::set_union(prescribed.begin(), prescribed.end(), sliding.begin(), sliding.end(),
      std::back_inserter(given));
    all.together([&] { partition = volume.partition(given); });
    given = this->pieces_->extend(partition).prescribed;
    std::set_difference(given.begin(), given.end(), ofPieces.prescribed.begin(),
      ofPieces.prescribed.end(), std::back_inserter(centers));
    this->centers_ = outerCenters(*this->pieces_, std::move(centers), silent);
  }
  else
  {
    this->pieces_ = nullptr;
    method->prepare(volume.mesh, partition, silent, volume.processes);
  }
  this->method_ = std::move(method);
  this->methodVersion_ = version;
  this->processes_ = volume.processes;
  this->sliding_ = sliding;
  this->prescribed_ = prescribed;
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
  if (model.mesh.numberOfCells() == 0)
  {
    throw Error("`SlideRounds` needs the mesh's cells, and the input is a surface. Give the "
                "volume mesh to this filter, or set `SlideRounds` to 0.");
  }
  const Volume volume =
    pieces ? Volume{ pieces->mesh(), pieces->hanging(), pieces->needsPieces(), pieces->processes() }
           : Volume{ model.mesh, model.hanging, needsPieces(model.mesh, model.hanging), nullptr };
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
  this->prepare(volume, model.inputVersion, own, prescribed, monitor);
  std::map<Index, Slide> slides; // by the method's nodes
  for (const auto& [node, ofBoundary] : here)
  {
    if (const Index at = this->pieces_ ? this->pieces_->nodeOf(node) : node; at >= 0)
    {
      slides[at] = { model.points().row(ofBoundary), sliding.at(ofBoundary) };
    }
  }
  if (this->pieces_)
  {
    const auto marks = [&](Index s)
    {
      Points isOn = Points::Zero(places.rows(), 3);
      for (const Index node : model.geometry.surfaces[s].nodes)
      {
        if (const Index at = pieces ? pieces->nodeOf(node) : node; at >= 0)
        {
          isOn(at, 0) = 1;
        }
      }
      return isOn;
    };
    addCenters(*this->pieces_, this->centers_, surfaces, marks, slides);
  }
  std::vector<Index> ofMethod;
  std::vector<const Slide*> ordered;
  for (const auto& [node, slide] : slides)
  {
    ofMethod.push_back(node);
    ordered.push_back(&slide);
  }
  const NodeSliding::Surfaces along = { [&](Index i, const Row& x)
    { return directionsAt(model, ordered[i]->on, shapes, x); },
    [&](Index i, const Row& x)
    { return shapes.slid(model, ordered[i]->on, ordered[i]->rest, x); } };
  volume.hanging.place(volume.mesh.points, places);
  Points all = this->pieces_ ? this->pieces_->extend(places) : std::move(places);
  this->rounds_ = this->method_->slide(ofMethod, along, limits, all, monitor);
  places = this->pieces_ ? this->pieces_->reduce(all, std::move(places)) : std::move(all);
  // In the order of the nodes' ids, as `nodes` are.
  result.moved(nodes, allColumns) = volume.all().gather(places, own);
  moveBetween(model, sliding, before, shapes, result.moved);
  for (const auto& [node, ofBoundary] : here)
  {
    places.row(node) = result.moved.row(ofBoundary);
  }
  volume.hanging.place(volume.mesh.points, places);
  result.moved(nodes, allColumns) = volume.all().gather(places, own);
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
