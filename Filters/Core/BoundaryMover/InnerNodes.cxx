// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMover/InnerNodes.h"

#include "BoundaryMorphing/BoundaryMotion.h"
#include "Geometry/AffineFit.h"
#include "Geometry/RotationFit.h"
#include "LinearMethods/FemWarp.h"
#include "Mesh/ShellLayer.h"
#include "Morpher/PolyhedralMorpher.h"
#include "Support/Error.h"
#include "Support/Lists.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace morph
{
namespace
{
std::vector<Index> flagged(const std::vector<std::uint8_t>& flags)
{
  std::vector<Index> ids;
  for (std::size_t i = 0; i < flags.size(); ++i)
  {
    if (flags[i])
    {
      ids.push_back(static_cast<Index>(i));
    }
  }
  return ids;
}

/// Returns the nodes of `zone` that a cell outside it has, too.
std::vector<Index> edgeOf(const Mesh& mesh, const Zone& part)
{
  std::vector<std::uint8_t> isEdge(mesh.numberOfNodes(), 0);
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    for (Index k = 0; !part.isCell[c] && k < mesh.cellSize(c); ++k)
    {
      const Index node = mesh.cell(c)[k];
      isEdge[node] = part.isNode[node];
    }
  }
  return flagged(isEdge);
}

[[noreturn]] void throwNoLayers(const std::string& array)
{
  throw Error(
    "There are no layers to keep: no hexahedra, nor wedges on triangles, lie on the "
    "faces that move" +
    (array.empty() ? std::string(".") : " where the cell array '" + array + "' is not zero.") +
    " Set `KeepLayers` to 0, or let whole faces of the wall move.");
}

}

InnerPieces::~InnerPieces() = default;

std::vector<Index> InnerPieces::place(const Prescribed& given, Points& places) const
{
  std::vector<Index> prescribed = given.points;
  places = this->mesh().points;
  places(prescribed, allColumns) = given.pointPlaces;
  for (std::size_t i = 0; i < given.nodes.size(); ++i)
  {
    if (const Index node = this->nodeOf(given.nodes[i]); node >= 0)
    {
      prescribed.push_back(node);
      places.row(node) = given.nodePlaces.row(static_cast<Index>(i));
    }
  }
  this->processes()->spread(prescribed);
  this->processes()->update(places);
  return prescribed;
}

void takeNodes(const Mesh& mesh, std::vector<std::uint8_t> isNode, Zone& zone)
{
  markImages(mesh.layer, isNode);
  zone.isNode = std::move(isNode);
  zone.isCell.assign(mesh.numberOfCells(), 0);
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    zone.isCell[c] = std::all_of(mesh.cell(c), mesh.cell(c) + mesh.cellSize(c),
      [&](Index node) { return zone.isNode[node] != 0; });
  }
}

void takeCells(const Mesh& mesh, std::vector<std::uint8_t> isCell, Zone& zone)
{
  zone.isCell = std::move(isCell);
  zone.isNode.assign(mesh.numberOfNodes(), 0);
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    for (Index k = 0; zone.isCell[c] && k < mesh.cellSize(c); ++k)
    {
      zone.isNode[mesh.cell(c)[k]] = 1;
    }
  }
}

void InnerNodes::clear()
{
  this->fixedNodes_.clear();
  this->rigidZones_.clear();
  this->pointOf_.clear();
  this->numberOf_.clear();
}

void InnerNodes::take(const BoundaryModel& model, const std::vector<Zone>& fixed,
  const std::vector<Zone>& rigid, const InnerPieces* pieces)
{
  this->clear();
  this->pieces_ = pieces;
  const Mesh& mesh = pieces ? pieces->piece() : model.mesh;
  const auto nodesOf = [&](const InnerPieces::Flags& flags)
  { return pieces ? this->nodesOf(model, flags) : flagged(flags); };
  InnerPieces::Flags isTaken(mesh.numberOfNodes(), 0);
  for (const Zone& zone : fixed)
  {
    for (std::size_t n = 0; n < isTaken.size(); ++n)
    {
      isTaken[n] = isTaken[n] || zone.isNode[n];
    }
  }
  this->fixedNodes_ = nodesOf(isTaken);
  for (const Zone& zone : rigid)
  {
    Rigid& next = this->rigidZones_.emplace_back();
    next.edge = edgeOf(mesh, zone);
    InnerPieces::Flags isEdge(isTaken.size(), 0), isNew = zone.isNode;
    for (std::size_t n = 0; n < isTaken.size(); ++n)
    {
      isNew[n] = isNew[n] && !isTaken[n];
      isTaken[n] = isTaken[n] || isNew[n];
    }
    if (pieces)
    {
      for (const Index node : next.edge)
      {
        isEdge[node] = 1;
      }
      next.isNode = isNew;
      next.isEdge = pieces->anyFlags(isEdge);
    }
    next.nodes = nodesOf(isNew);
  }
}

std::vector<Index> InnerNodes::nodesOf(
  const BoundaryModel& model, const InnerPieces::Flags& ofPiece)
{
  std::vector<Index> nodes = flagged(this->pieces_->nodeFlags(ofPiece));
  // The gathered cells have inner nodes, too.
  const std::vector<Index>& outer = model.faces.nodes;
  nodes.erase(std::remove_if(nodes.begin(), nodes.end(),
                [&](Index node) { return !std::binary_search(outer.begin(), outer.end(), node); }),
    nodes.end());
  std::vector<Index> points = this->pieces_->ownInner(ofPiece), ofBoundary;
  std::transform(outer.begin(), outer.end(), std::back_inserter(ofBoundary),
    [&](Index node) { return this->pieces_->nodeOf(node); });
  sortUnique(ofBoundary);
  points.erase(
    std::remove_if(points.begin(), points.end(), // those of inner surfaces
      [&](Index point) { return std::binary_search(ofBoundary.begin(), ofBoundary.end(), point); }),
    points.end());
  const std::vector<Index> inner = this->addPoints(model, points);
  nodes.insert(nodes.end(), inner.begin(), inner.end());
  return nodes;
}

std::vector<Index> InnerNodes::addPoints(
  const BoundaryModel& model, const std::vector<Index>& ofPiece)
{
  std::vector<Index> numbers;
  for (const Index point : ofPiece)
  {
    const auto [found, isNew] =
      this->numberOf_.emplace(point, static_cast<Index>(this->pointOf_.size()));
    if (isNew)
    {
      this->pointOf_.push_back(point);
    }
    numbers.push_back(model.points().rows() + found->second);
  }
  return numbers;
}

Eigen::RowVector3d InnerNodes::restOf(const BoundaryModel& model, Index node) const
{
  const Index beyond = node - model.points().rows();
  return beyond < 0 ? model.points().row(node)
                    : this->pieces_->piece().points.row(this->pointOf_[beyond]);
}

Points InnerNodes::rest(const BoundaryModel& model) const
{
  const Index before = model.rest().rows();
  Points rest(before + static_cast<Index>(this->pointOf_.size()), 3);
  rest.topRows(before) = model.rest();
  for (Index node = before; node < rest.rows(); ++node)
  {
    rest.row(node) = this->restOf(model, node);
  }
  return rest;
}

void InnerNodes::constrain(
  const BoundaryModel& model, const Options& options, Choice& choice, Points& targets) const
{
  TargetOfNode moving = targetsOf(choice, targets);
  std::vector<Index> held = choice.held;
  const auto isOuter = [&](Index node)
  { return std::binary_search(model.faces.nodes.begin(), model.faces.nodes.end(), node); };
  for (const Index node : this->fixedNodes_)
  {
    if (isOuter(node))
    {
      moving.erase(node);
      held.push_back(node);
    }
  }
  for (const Rigid& zone : this->rigidZones_)
  {
    for (const Index node : zone.nodes)
    {
      if (options.rigid && isOuter(node))
      {
        moving[node] = options.rigid(model.points().row(node));
      }
    }
  }
  setMoving(moving, choice, targets);
  sortUnique(held);
  choice.held.clear();
  std::copy_if(held.begin(), held.end(), std::back_inserter(choice.held),
    [&](Index node) { return moving.count(node) == 0; });
}

void InnerNodes::place(const BoundaryModel& model, const Choice& choice, const Options& options,
  Surroundings::Result& result, Monitor& monitor)
{
  const std::vector<Index>& outer = model.faces.nodes;
  const Points before = result.moved(outer, allColumns);
  if (options.keepLayers > 0)
  {
    this->keepLayers(model, choice, options, result);
  }
  this->extend(model, result);
  const auto set = [&](Index node, const Eigen::RowVector3d& to)
  {
    result.moved.row(node) = to;
    result.roles[node] = Surroundings::IsZone;
  };
  for (const Index node : this->fixedNodes_)
  {
    set(node, this->restOf(model, node));
  }
  for (const Rigid& zone : this->rigidZones_)
  {
    for (const Index node : zone.nodes)
    {
      if (options.rigid)
      {
        set(node, options.rigid(this->restOf(model, node)));
      }
    }
  }
  for (const Rigid& zone : this->rigidZones_)
  {
    if (!options.rigid)
    {
      this->moveRigidly(zone, model, result, monitor);
    }
  }
  this->hasMovedOuter_ = before != result.moved(outer, allColumns);
}

bool InnerNodes::spreadAround(const BoundaryModel& model, const Choice& choice,
  const Points& targets, const Surroundings::Options& options, Surroundings::Result& result,
  Monitor& monitor)
{
  if (!this->hasMovedOuter_)
  {
    return false;
  }
  const auto isPlaced = [&result](Index node)
  {
    return result.roles[node] == Surroundings::IsZone ||
           result.roles[node] == Surroundings::IsLayer;
  };
  TargetOfNode moving;
  for (const Index node : model.faces.nodes)
  {
    if (isPlaced(node) && !std::binary_search(choice.held.begin(), choice.held.end(), node))
    {
      moving[node] = result.moved.row(node);
    }
  }
  if (moving.empty())
  {
    return false;
  }
  for (const auto& [node, to] : targetsOf(choice, targets))
  {
    moving[node] = to;
  }
  Choice all = choice;
  Points places;
  setMoving(moving, all, places);
  const Surroundings::Result around = this->around_.spread(model, all, places, options, monitor);
  for (const Index node : model.faces.nodes)
  {
    if (!isPlaced(node))
    {
      result.moved.row(node) = around.moved.row(node);
      result.roles[node] = around.roles[node];
    }
  }
  return true;
}

void InnerNodes::keepLayers(const BoundaryModel& model, const Choice& choice,
  const Options& options, Surroundings::Result& result)
{
  if (this->pieces_)
  {
    this->layers_ = this->layersOnRanks(model, choice, options);
    this->layersVersion_ = -1;
    this->extend(model, result);
    this->moveLayers(this->rest(model), model, choice, result);
    return;
  }
  if (this->layersVersion_ != model.inputVersion || this->layersMost_ != options.keepLayers ||
      this->layersWall_ != choice.isMovingFace || this->layersCells_ != options.isLayer)
  {
    this->layersVersion_ = -1;
    this->layers_ = findWallLayers(
      model.mesh, model.faces, choice.isMovingFace, options.keepLayers, options.isLayer);
    this->layersMost_ = options.keepLayers;
    this->layersWall_ = choice.isMovingFace;
    this->layersCells_ = options.isLayer;
    this->layersVersion_ = model.inputVersion;
  }
  if (this->layers_.columns.values.empty())
  {
    throwNoLayers(options.layersName);
  }
  this->moveLayers(model.points(), model, choice, result);
}

void InnerNodes::moveLayers(const Points& rest, const BoundaryModel& model, const Choice& choice,
  Surroundings::Result& result) const
{
  morph::moveLayers(rest, model.faces, choice.isMovingFace, this->layers_, result.moved);
  for (const Index node : this->layers_.columns.values)
  {
    result.roles[node] = Surroundings::IsLayer;
  }
}

WallLayers InnerNodes::layersOnRanks(
  const BoundaryModel& model, const Choice& choice, const Options& options)
{
  if (model.inner.size() > 0)
  {
    throw Error("On several MPI ranks no layers are kept in a mesh with baffles or other inner "
                "surfaces. Run on one rank, or without `KeepLayers`.");
  }
  const InnerPieces::Columns found =
    this->pieces_->findLayers(choice.isMovingFace, options.keepLayers, options.isLayer);
  if (!this->pieces_->anywhere(!found.nodes.empty() || !found.points.empty()))
  {
    throwNoLayers(options.layersName);
  }
  std::map<Index, std::vector<Index>> columnOf;
  for (std::size_t f = 0; f < choice.isMovingFace.size(); ++f)
  {
    const std::vector<Index>& offsets = model.faces.offsets;
    for (Index k = offsets[f]; choice.isMovingFace[f] && k < offsets[f + 1]; ++k)
    {
      columnOf[model.faces.connectivity[k]];
    }
  }
  for (const auto& [node, wall] : found.nodes)
  {
    columnOf[wall].push_back(node);
  }
  for (const auto& [point, wall] : found.points)
  {
    columnOf[wall].push_back(this->addPoints(model, { point }).front());
  }
  return wallLayers(columnOf);
}

void InnerNodes::extend(const BoundaryModel& model, Surroundings::Result& result) const
{
  const Index before = result.moved.rows(),
              all = model.points().rows() + static_cast<Index>(this->pointOf_.size());
  result.moved.conservativeResize(all, 3);
  result.roles.resize(all, Surroundings::Stays);
  for (Index node = before; node < all; ++node)
  {
    result.moved.row(node) = this->restOf(model, node);
  }
}

void InnerNodes::moveRigidly(
  const Rigid& zone, const BoundaryModel& model, Surroundings::Result& result, Monitor& monitor)
{
  // Three nodes that are not on a line tell the motion: those that move or, where these do not tell
  // it, held ones too, then all.
  std::vector<Index> outer;
  bool isTold = false;
  const auto isMoved = [](int role) { return role == Surroundings::Moves; };
  const auto isGiven = [](int role)
  { return role == Surroundings::Moves || role == Surroundings::IsHeld; };
  const auto isAny = [](int role) { return role != Surroundings::IsFree; };
  for (bool (*tells)(int) : { +isMoved, +isGiven, +isAny })
  {
    outer.clear();
    std::copy_if(zone.nodes.begin(), zone.nodes.end(), std::back_inserter(outer),
      [&](Index node)
      {
        return tells(result.roles[node]) &&
               std::binary_search(model.faces.nodes.begin(), model.faces.nodes.end(), node);
      });
    isTold = AffineLeastSquares(model.points()(outer, allColumns)).directions().rank() >= 2;
    if (isTold)
    {
      break;
    }
  }
  const Moved by = isTold
                     ? Moved{ model.points()(outer, allColumns), result.moved(outer, allColumns) }
                     : this->guess(zone, model, result, monitor);
  const RigidMotion motion = fitRigidMotion(by.from, by.to);
  const bool stays = (by.to - by.from).isZero(0);
  for (const Index node : zone.nodes)
  {
    const Eigen::RowVector3d x = this->restOf(model, node);
    result.moved.row(node) = stays ? x : motion(x);
    result.roles[node] = Surroundings::IsZone;
  }
}

std::vector<Index> InnerNodes::prescribed(
  const BoundaryModel& model, const Surroundings::Result& result)
{
  std::vector<Index> prescribed;
  for (Index n = 0; n < model.points().rows(); ++n)
  {
    const bool isOuter = std::binary_search(model.faces.nodes.begin(), model.faces.nodes.end(), n);
    if (isOuter ? result.roles[n] != Surroundings::IsFree : result.roles[n] != Surroundings::Stays)
    {
      prescribed.push_back(n);
    }
  }
  return prescribed;
}

InnerPieces::Prescribed InnerNodes::prescribedOnRanks(const BoundaryModel& model,
  const Surroundings::Result& result, const std::vector<Index>& others) const
{
  InnerPieces::Prescribed given;
  for (const Index node : model.faces.nodes)
  {
    if (result.roles[node] != Surroundings::IsFree &&
        !std::binary_search(others.begin(), others.end(), node))
    {
      given.nodes.push_back(node);
    }
  }
  std::vector<Index> inner;
  for (std::size_t i = 0; i < this->pointOf_.size(); ++i)
  {
    const Index node = model.points().rows() + static_cast<Index>(i);
    if (result.roles[node] != Surroundings::Stays)
    {
      given.points.push_back(this->pointOf_[i]);
      inner.push_back(node);
    }
  }
  given.nodePlaces = result.moved(given.nodes, allColumns);
  given.pointPlaces = result.moved(inner, allColumns);
  return given;
}

InnerNodes::Moved InnerNodes::guess(const Rigid& zone, const BoundaryModel& model,
  const Surroundings::Result& result, Monitor& monitor)
{
  const Mesh& mesh = this->pieces_ ? this->pieces_->mesh() : model.mesh;
  const std::shared_ptr<const Communicator> others =
    this->pieces_ ? this->pieces_->processes() : nullptr;
  const Communicator& processes = others ? *others : Communicator::alone();
  const HangingNodes& hanging = this->pieces_ ? this->pieces_->hanging() : model.hanging;
  Points places;
  std::vector<Index> given, by = zone.edge.empty() ? zone.nodes : zone.edge;
  if (this->pieces_)
  {
    given = this->pieces_->place(this->prescribedOnRanks(model, result, {}), places);
    by = flagged(processes.all(flagged(zone.isEdge).empty()) ? zone.isNode : zone.isEdge);
  }
  else
  {
    given = prescribed(model, result);
    places = result.moved;
  }
  given = hanging.without(given); // these follow what they hang on
  if (!processes.all(this->method_ && this->methodVersion_ == model.inputVersion &&
                     &this->method_->processes() == &processes &&
                     this->method_->partition().prescribed == given))
  {
    std::unique_ptr<Morpher> method = std::make_unique<FemWarp>();
    this->method_ = nullptr; // in case it throws
    if (this->pieces_ ? this->pieces_->needsPieces() : needsPieces(mesh, hanging))
    {
      method = morpherForPolyhedra(std::move(method), false, hanging);
    }
    NodePartition partition;
    processes.together([&] { partition = partitionNodes(mesh, hanging, given); });
    method->prepare(mesh, partition, monitor, others);
    this->method_ = std::move(method);
    this->methodVersion_ = model.inputVersion;
  }
  Points moved;
  this->method_->evaluate(places(given, allColumns), moved, monitor);
  return { processes.gather(mesh.points, by), processes.gather(moved, by) };
}

std::vector<Index> InnerNodes::placedInside(
  const BoundaryModel& model, const Surroundings::Result& result)
{
  std::vector<Index> nodes;
  for (Index n = 0; n < static_cast<Index>(result.roles.size()); ++n)
  {
    if ((result.roles[n] == Surroundings::IsZone || result.roles[n] == Surroundings::IsLayer) &&
        !std::binary_search(model.faces.nodes.begin(), model.faces.nodes.end(), n))
    {
      nodes.push_back(n);
    }
  }
  return nodes;
}

std::vector<Index> InnerNodes::pointsOf(
  const BoundaryModel& model, const std::vector<Index>& nodes) const
{
  std::vector<Index> points = nodes;
  for (Index& point : points)
  {
    point = this->pieces_ ? this->pointOf_[point - model.points().rows()] : point;
  }
  return points;
}
}
