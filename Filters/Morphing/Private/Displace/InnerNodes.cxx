// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Displace/InnerNodes.h"

#include "BoundaryMorphing/LayerMotion.h"
#include "Geometry/AffineFit.h"
#include "Geometry/RigidFit.h"
#include "LinearMethods/FemWarp.h"
#include "Mesh/Polyhedra.h"
#include "Morpher/PolyhedralMorpher.h"
#include "Private/Data/Surface.h"
#include "Private/Displace/Chosen.h"
#include "Private/Displace/InnerPoints.h"
#include "Private/Pipeline/Ranks.h"
#include "Support/Error.h"

#include <vtkAbstractTransform.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <map>

namespace morph::filters
{
namespace
{
using morph::Error;
using morph::Index;
using morph::Points;

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
std::vector<Index> edgeOf(const morph::Mesh& mesh, const Zones::Part& part)
{
  std::vector<std::uint8_t> isEdge(mesh.numberOfNodes(), 0);
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    for (Index k = 0; !part.IsCell[c] && k < mesh.cellSize(c); ++k)
    {
      const Index node = mesh.cell(c)[k];
      isEdge[node] = part.IsNode[node];
    }
  }
  return flagged(isEdge);
}

Eigen::RowVector3d transformed(
  vtkAbstractTransform* transform, double factor, const Eigen::RowVector3d& x)
{
  Eigen::RowVector3d to;
  transform->TransformPoint(x.data(), to.data());
  return factor == 1 ? to : Eigen::RowVector3d(x + factor * (to - x));
}

std::vector<std::uint8_t> layerCells(vtkUnstructuredGrid* grid, const std::string& name)
{
  if (name.empty())
  {
    return {};
  }
  vtkDataArray* array = grid->GetCellData()->GetArray(name.c_str());
  if (!array || array->GetNumberOfTuples() != grid->GetNumberOfCells())
  {
    throw Error("LayersArray names '" + name + "', which is no cell array of the input.");
  }
  return Chosen::Marked(array);
}

[[noreturn]] void throwNoLayers(const std::string& array)
{
  throw Error(
    "There are no layers to keep: no hexahedra, nor wedges on triangles, lie on the "
    "faces that move" +
    (array.empty() ? std::string(".") : " where the cell array '" + array + "' is not zero.") +
    " Set KeepLayers to 0, or let whole faces of the wall move.");
}

/// Where nodes move, in the order of their ids.
using PlaceOfNode = std::map<Index, Eigen::RowVector3d>;

PlaceOfNode placesOf(const Choice& choice, const Points& targets)
{
  PlaceOfNode places;
  for (std::size_t i = 0; i < choice.moving.size(); ++i)
  {
    places[choice.moving[i]] = targets.row(static_cast<Index>(i));
  }
  return places;
}

void setMoving(const PlaceOfNode& places, Choice& choice, Points& targets)
{
  choice.moving.clear();
  targets.resize(static_cast<Index>(places.size()), 3);
  for (const auto& [node, to] : places)
  {
    targets.row(static_cast<Index>(choice.moving.size())) = to;
    choice.moving.push_back(node);
  }
}
}

void InnerNodes::Clear()
{
  this->FixedNodes.clear();
  this->RigidZones.clear();
  this->PointOf.clear();
  this->NumberOf.clear();
}

void InnerNodes::Find(vtkUnstructuredGrid* grid, const BoundaryModel& model,
  const MergedBlocks* blocks, const Options& options, const WholeSurface* whole)
{
  this->Clear();
  this->Whole = whole;
  if (whole)
  {
    this->FindOnRanks(grid, model, blocks, options);
    return;
  }
  const morph::Mesh& mesh = model.mesh;
  std::vector<std::uint8_t> isTaken(mesh.numberOfNodes(), 0);
  for (const Zones::Part& part : Zones::Find(Zones::Fixed, grid, mesh, blocks, options.Zones))
  {
    for (std::size_t n = 0; n < isTaken.size(); ++n)
    {
      isTaken[n] = isTaken[n] || part.IsNode[n];
    }
  }
  this->FixedNodes = flagged(isTaken);
  for (const Zones::Part& part : Zones::Find(Zones::Rigid, grid, mesh, blocks, options.Zones))
  {
    Zone& zone = this->RigidZones.emplace_back();
    zone.Edge = edgeOf(mesh, part);
    for (const Index node : flagged(part.IsNode))
    {
      if (!isTaken[node])
      {
        zone.Nodes.push_back(node);
        isTaken[node] = 1;
      }
    }
  }
}

void InnerNodes::FindOnRanks(vtkUnstructuredGrid* grid, const BoundaryModel& model,
  const MergedBlocks* blocks, const Options& options)
{
  const WholeVolume volume(*this->Whole);
  WholeVolume::Flags isTaken(volume.Piece().numberOfNodes(), 0);
  for (const Zones::Part& part :
    Zones::FindOnRanks(Zones::Fixed, grid, volume, blocks, options.Zones))
  {
    for (std::size_t n = 0; n < isTaken.size(); ++n)
    {
      isTaken[n] = isTaken[n] || part.IsNode[n];
    }
  }
  this->FixedNodes = this->NodesOf(model, isTaken);
  for (const Zones::Part& part :
    Zones::FindOnRanks(Zones::Rigid, grid, volume, blocks, options.Zones))
  {
    Zone& zone = this->RigidZones.emplace_back();
    WholeVolume::Flags isEdge(isTaken.size(), 0), isNew = part.IsNode;
    for (const Index node : edgeOf(volume.Piece(), part))
    {
      isEdge[node] = 1;
    }
    for (std::size_t n = 0; n < isTaken.size(); ++n)
    {
      isNew[n] = isNew[n] && !isTaken[n];
      isTaken[n] = isTaken[n] || isNew[n];
    }
    zone.IsNode = isNew;
    zone.IsEdge = volume.AnyFlags(isEdge);
    zone.Nodes = this->NodesOf(model, isNew);
  }
}

std::vector<Index> InnerNodes::NodesOf(
  const BoundaryModel& model, const WholeVolume::Flags& ofPiece)
{
  std::vector<Index> nodes = flagged(this->Whole->AnyFlags(ofPiece));
  // The gathered cells have inner nodes, too.
  const std::vector<Index>& outer = model.faces.nodes;
  nodes.erase(std::remove_if(nodes.begin(), nodes.end(),
                [&](Index node) { return !std::binary_search(outer.begin(), outer.end(), node); }),
    nodes.end());
  const std::vector<Index> inner =
    this->AddPoints(model, WholeVolume(*this->Whole).OwnInner(ofPiece));
  nodes.insert(nodes.end(), inner.begin(), inner.end());
  return nodes;
}

std::vector<Index> InnerNodes::AddPoints(
  const BoundaryModel& model, const std::vector<Index>& ofPiece)
{
  std::vector<Index> numbers;
  for (const Index point : ofPiece)
  {
    const auto [found, isNew] =
      this->NumberOf.emplace(point, static_cast<Index>(this->PointOf.size()));
    if (isNew)
    {
      this->PointOf.push_back(point);
    }
    numbers.push_back(model.points().rows() + found->second);
  }
  return numbers;
}

Eigen::RowVector3d InnerNodes::RestOf(const BoundaryModel& model, Index node) const
{
  const Index beyond = node - model.points().rows();
  return beyond < 0 ? model.points().row(node)
                    : WholeVolume(*this->Whole).Piece().points.row(this->PointOf[beyond]);
}

Points InnerNodes::Rest(const BoundaryModel& model) const
{
  const Index before = model.rest().rows();
  Points rest(before + static_cast<Index>(this->PointOf.size()), 3);
  rest.topRows(before) = model.rest();
  for (Index node = before; node < rest.rows(); ++node)
  {
    rest.row(node) = this->RestOf(model, node);
  }
  return rest;
}

void InnerNodes::Constrain(
  const BoundaryModel& model, const Options& options, Choice& choice, Points& targets) const
{
  PlaceOfNode moving = placesOf(choice, targets);
  std::vector<Index> held = choice.held;
  const auto isOuter = [&](Index node)
  { return std::binary_search(model.faces.nodes.begin(), model.faces.nodes.end(), node); };
  for (const Index node : this->FixedNodes)
  {
    if (isOuter(node))
    {
      moving.erase(node);
      held.push_back(node);
    }
  }
  for (const Zone& zone : this->RigidZones)
  {
    for (const Index node : zone.Nodes)
    {
      if (options.RigidTransform && isOuter(node))
      {
        moving[node] =
          transformed(options.RigidTransform, options.ScaleFactor, model.points().row(node));
      }
    }
  }
  setMoving(moving, choice, targets);
  std::sort(held.begin(), held.end());
  held.erase(std::unique(held.begin(), held.end()), held.end());
  choice.held.clear();
  std::copy_if(held.begin(), held.end(), std::back_inserter(choice.held),
    [&](Index node) { return moving.count(node) == 0; });
}

void InnerNodes::Place(vtkUnstructuredGrid* grid, const BoundaryModel& model, const Choice& choice,
  const Options& options, Surroundings::Result& result, morph::Monitor& monitor)
{
  const std::vector<Index>& outer = model.faces.nodes;
  const Points before = result.moved(outer, morph::allColumns);
  if (options.KeepLayers > 0)
  {
    this->KeepLayers(grid, model, choice, options, result);
  }
  this->Extend(model, result);
  const auto set = [&](Index node, const Eigen::RowVector3d& to)
  {
    result.moved.row(node) = to;
    result.roles[node] = Surroundings::IsZone;
  };
  for (const Index node : this->FixedNodes)
  {
    set(node, this->RestOf(model, node));
  }
  for (const Zone& zone : this->RigidZones)
  {
    for (const Index node : zone.Nodes)
    {
      if (options.RigidTransform)
      {
        set(node,
          transformed(options.RigidTransform, options.ScaleFactor, this->RestOf(model, node)));
      }
    }
  }
  for (const Zone& zone : this->RigidZones)
  {
    if (!options.RigidTransform)
    {
      this->MoveRigidly(zone, model, result, monitor);
    }
  }
  this->HasMovedOuter = before != result.moved(outer, morph::allColumns);
}

void InnerNodes::SpreadAround(const BoundaryModel& model, const Choice& choice,
  const Points& targets, const Surroundings::Options& options, Surroundings::Result& result,
  morph::Monitor& monitor)
{
  if (!this->HasMovedOuter)
  {
    return;
  }
  const auto isPlaced = [&result](Index node)
  {
    return result.roles[node] == Surroundings::IsZone ||
           result.roles[node] == Surroundings::IsLayer;
  };
  PlaceOfNode moving;
  for (const Index node : model.faces.nodes)
  {
    if (isPlaced(node) && !std::binary_search(choice.held.begin(), choice.held.end(), node))
    {
      moving[node] = result.moved.row(node);
    }
  }
  if (moving.empty())
  {
    return;
  }
  for (const auto& [node, to] : placesOf(choice, targets))
  {
    moving[node] = to;
  }
  Choice all = choice;
  Points places;
  setMoving(moving, all, places);
  const Surroundings::Result around = this->Around.spread(model, all, places, options, monitor);
  for (const Index node : model.faces.nodes)
  {
    if (!isPlaced(node))
    {
      result.moved.row(node) = around.moved.row(node);
      result.roles[node] = around.roles[node];
    }
  }
}

void InnerNodes::KeepLayers(vtkUnstructuredGrid* grid, const BoundaryModel& model,
  const Choice& choice, const Options& options, Surroundings::Result& result)
{
  if (this->Whole)
  {
    this->Layers = this->LayersOnRanks(grid, model, choice, options);
    this->LayersKey.clear();
    this->Extend(model, result);
    this->MoveLayers(this->Rest(model), model, choice, result);
    return;
  }
  const std::vector<std::uint8_t> isLayer = layerCells(grid, options.LayersArray);
  std::string key = std::to_string(model.inputVersion) + " " + std::to_string(options.KeepLayers) +
                    " " + options.LayersArray;
  if (key != this->LayersKey || this->LayersWall != choice.isMovingFace)
  {
    this->LayersKey.clear();
    this->Layers = morph::findWallLayers(
      model.mesh, model.faces, choice.isMovingFace, options.KeepLayers, isLayer);
    this->LayersWall = choice.isMovingFace;
    this->LayersKey = std::move(key);
  }
  if (this->Layers.columns.values.empty())
  {
    throwNoLayers(options.LayersArray);
  }
  this->MoveLayers(model.points(), model, choice, result);
}

void InnerNodes::MoveLayers(const Points& rest, const BoundaryModel& model, const Choice& choice,
  Surroundings::Result& result) const
{
  morph::moveLayers(rest, model.faces, choice.isMovingFace, this->Layers, result.moved);
  for (const Index node : this->Layers.columns.values)
  {
    result.roles[node] = Surroundings::IsLayer;
  }
}

morph::WallLayers InnerNodes::LayersOnRanks(vtkUnstructuredGrid* grid, const BoundaryModel& model,
  const Choice& choice, const Options& options)
{
  const WholeVolume volume(*this->Whole);
  std::vector<std::uint8_t> isLayer;
  Ranks::Together(
    [&]
    {
      if (grid->GetNumberOfCells() > 0) // others have no arrays
      {
        isLayer = layerCells(grid, options.LayersArray);
      }
    });
  const WholeVolume::Columns found =
    volume.FindLayers(choice.isMovingFace, options.KeepLayers, isLayer);
  if (Ranks::Count(!found.Nodes.empty() || !found.Points.empty()) == 0)
  {
    throwNoLayers(options.LayersArray);
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
  for (const auto& [node, wall] : found.Nodes)
  {
    columnOf[wall].push_back(node);
  }
  for (const auto& [point, wall] : found.Points)
  {
    columnOf[wall].push_back(this->AddPoints(model, { point }).front());
  }
  morph::WallLayers layers;
  layers.columns.offsets = { 0 };
  for (const auto& [wall, column] : columnOf)
  {
    layers.walls.push_back(wall);
    layers.columns.values.insert(layers.columns.values.end(), column.begin(), column.end());
    layers.columns.offsets.push_back(static_cast<Index>(layers.columns.values.size()));
  }
  return layers;
}

void InnerNodes::Extend(const BoundaryModel& model, Surroundings::Result& result) const
{
  const Index before = result.moved.rows(),
              all = model.points().rows() + static_cast<Index>(this->PointOf.size());
  result.moved.conservativeResize(all, 3);
  result.roles.resize(all, Surroundings::Stays);
  for (Index node = before; node < all; ++node)
  {
    result.moved.row(node) = this->RestOf(model, node);
  }
}

void InnerNodes::MoveRigidly(const Zone& zone, const BoundaryModel& model,
  Surroundings::Result& result, morph::Monitor& monitor)
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
    std::copy_if(zone.Nodes.begin(), zone.Nodes.end(), std::back_inserter(outer),
      [&](Index node)
      {
        return tells(result.roles[node]) &&
               std::binary_search(model.faces.nodes.begin(), model.faces.nodes.end(), node);
      });
    isTold =
      morph::AffineLeastSquares(model.points()(outer, morph::allColumns)).directions().rank() >= 2;
    if (isTold)
    {
      break;
    }
  }
  const WholeVolume::Moved by = isTold
                                  ? WholeVolume::Moved{ model.points()(outer, morph::allColumns),
                                      result.moved(outer, morph::allColumns) }
                                  : this->Guess(zone, model, result, monitor);
  const morph::RigidMotion motion = morph::fitRigidMotion(by.From, by.To);
  const bool stays = (by.To - by.From).isZero(0);
  for (const Index node : zone.Nodes)
  {
    const Eigen::RowVector3d x = this->RestOf(model, node);
    result.moved.row(node) = stays ? x : motion(x);
    result.roles[node] = Surroundings::IsZone;
  }
}

std::vector<Index> InnerNodes::Prescribed(
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

WholeVolume::Prescribed InnerNodes::PrescribedOnRanks(const BoundaryModel& model,
  const Surroundings::Result& result, const std::vector<Index>& others) const
{
  WholeVolume::Prescribed given;
  for (const Index node : model.faces.nodes)
  {
    if (result.roles[node] != Surroundings::IsFree &&
        !std::binary_search(others.begin(), others.end(), node))
    {
      given.Nodes.push_back(node);
    }
  }
  std::vector<Index> inner;
  for (std::size_t i = 0; i < this->PointOf.size(); ++i)
  {
    const Index node = model.points().rows() + static_cast<Index>(i);
    if (result.roles[node] != Surroundings::Stays)
    {
      given.Points.push_back(this->PointOf[i]);
      inner.push_back(node);
    }
  }
  given.NodePlaces = result.moved(given.Nodes, morph::allColumns);
  given.PointPlaces = result.moved(inner, morph::allColumns);
  return given;
}

WholeVolume::Moved InnerNodes::Guess(const Zone& zone, const BoundaryModel& model,
  const Surroundings::Result& result, morph::Monitor& monitor)
{
  if (this->Whole)
  {
    const WholeVolume volume(*this->Whole);
    volume.RequireNoPolyhedra("A rigid zone whose motion its boundary does not tell");
    const bool hasEdge =
      Ranks::Count(std::count(zone.IsEdge.begin(), zone.IsEdge.end(), 1) > 0) > 0;
    return volume.Warp(
      this->PrescribedOnRanks(model, result, {}), hasEdge ? zone.IsEdge : zone.IsNode, monitor);
  }
  const morph::Mesh& mesh = model.mesh;
  const std::vector<Index> prescribed = Prescribed(model, result);
  if (!this->Method || this->MethodVersion != model.inputVersion ||
      this->Method->partition().prescribed != prescribed)
  {
    std::unique_ptr<morph::Morpher> method = std::make_unique<morph::FemWarp>();
    this->Method = nullptr; // in case it throws
    if (morph::hasPolyhedra(mesh))
    {
      method = morph::morpherForPolyhedra(std::move(method));
    }
    method->prepare(mesh, morph::partitionNodes(mesh, prescribed), monitor);
    this->Method = std::move(method);
    this->MethodVersion = model.inputVersion;
  }
  Points moved;
  this->Method->evaluate(result.moved(prescribed, morph::allColumns), moved, monitor);
  const std::vector<Index>& by = zone.Edge.empty() ? zone.Nodes : zone.Edge;
  return { model.points()(by, morph::allColumns), moved(by, morph::allColumns) };
}

void InnerNodes::Append(vtkUnstructuredGrid* grid, const BoundaryModel& model,
  const Surroundings::Result& result, vtkPolyData* output) const
{
  std::vector<Index> nodes, points;
  std::vector<signed char> roles;
  for (Index n = 0; n < static_cast<Index>(result.roles.size()); ++n)
  {
    if ((result.roles[n] == Surroundings::IsZone || result.roles[n] == Surroundings::IsLayer) &&
        !std::binary_search(model.faces.nodes.begin(), model.faces.nodes.end(), n))
    {
      nodes.push_back(n);
      points.push_back(this->Whole ? this->PointOf[n - model.points().rows()] : n);
      roles.push_back(result.roles[n]);
    }
  }
  InnerPoints::Append(grid, points, this->Rest(model)(nodes, morph::allColumns),
    result.moved(nodes, morph::allColumns), roles, output);
  if (this->Whole)
  {
    this->Whole->MakeIdsGlobal(output, static_cast<vtkIdType>(nodes.size()));
  }
}
}
