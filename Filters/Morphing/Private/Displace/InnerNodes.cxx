// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Displace/InnerNodes.h"

#include "BoundaryMorphing/LayerMotion.h"
#include "Geometry/AffineFit.h"
#include "Geometry/RigidFit.h"
#include "LinearMethods/FemWarp.h"
#include "Mesh/Polyhedra.h"
#include "Morpher/PolyhedralMorpher.h"
#include "Private/Data/Surface.h"
#include "Private/Displace/InnerPoints.h"
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
  return Choice::Marked(array);
}

/// Where nodes move, in the order of their ids.
using PlaceOfNode = std::map<Index, Eigen::RowVector3d>;

PlaceOfNode placesOf(const Choice::Result& choice, const Points& targets)
{
  PlaceOfNode places;
  for (std::size_t i = 0; i < choice.Moving.size(); ++i)
  {
    places[choice.Moving[i]] = targets.row(static_cast<Index>(i));
  }
  return places;
}

void setMoving(const PlaceOfNode& places, Choice::Result& choice, Points& targets)
{
  choice.Moving.clear();
  targets.resize(static_cast<Index>(places.size()), 3);
  for (const auto& [node, to] : places)
  {
    targets.row(static_cast<Index>(choice.Moving.size())) = to;
    choice.Moving.push_back(node);
  }
}
}

void InnerNodes::Find(vtkUnstructuredGrid* grid, const BoundaryModel& model,
  const MergedBlocks* blocks, const Options& options)
{
  const morph::Mesh& mesh = model.Mesh();
  std::vector<std::uint8_t> isTaken(mesh.numberOfNodes(), 0);
  for (const Zones::Part& part : Zones::Find(Zones::Frozen, grid, mesh, blocks, options.Zones))
  {
    for (std::size_t n = 0; n < isTaken.size(); ++n)
    {
      isTaken[n] = isTaken[n] || part.IsNode[n];
    }
  }
  this->FrozenNodes = flagged(isTaken);
  this->RigidZones.clear();
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

void InnerNodes::Constrain(
  const BoundaryModel& model, const Options& options, Choice::Result& choice, Points& targets) const
{
  PlaceOfNode moving = placesOf(choice, targets);
  std::vector<Index> held = choice.Held;
  const auto isOuter = [&](Index node)
  { return std::binary_search(model.Faces().nodes.begin(), model.Faces().nodes.end(), node); };
  for (const Index node : this->FrozenNodes)
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
          transformed(options.RigidTransform, options.ScaleFactor, model.Points().row(node));
      }
    }
  }
  setMoving(moving, choice, targets);
  std::sort(held.begin(), held.end());
  held.erase(std::unique(held.begin(), held.end()), held.end());
  choice.Held.clear();
  std::copy_if(held.begin(), held.end(), std::back_inserter(choice.Held),
    [&](Index node) { return moving.count(node) == 0; });
}

void InnerNodes::Place(vtkUnstructuredGrid* grid, const BoundaryModel& model,
  const Choice::Result& choice, const Options& options, Surroundings::Result& result,
  morph::Monitor& monitor)
{
  const std::vector<Index>& outer = model.Faces().nodes;
  const Points before = result.Moved(outer, morph::allColumns);
  if (options.KeepLayers > 0)
  {
    this->KeepLayers(grid, model, choice, options, result);
  }
  const auto set = [&](Index node, const Eigen::RowVector3d& to)
  {
    result.Moved.row(node) = to;
    result.Roles[node] = Surroundings::IsZone;
  };
  for (const Index node : this->FrozenNodes)
  {
    set(node, model.Points().row(node));
  }
  for (const Zone& zone : this->RigidZones)
  {
    for (const Index node : zone.Nodes)
    {
      if (options.RigidTransform)
      {
        set(
          node, transformed(options.RigidTransform, options.ScaleFactor, model.Points().row(node)));
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
  this->HasMovedOuter = before != result.Moved(outer, morph::allColumns);
}

void InnerNodes::SpreadAround(const BoundaryModel& model, const Choice::Result& choice,
  const Points& targets, const Surroundings::Options& options, Surroundings::Result& result,
  morph::Monitor& monitor)
{
  if (!this->HasMovedOuter)
  {
    return;
  }
  const auto isPlaced = [&result](Index node)
  {
    return result.Roles[node] == Surroundings::IsZone ||
           result.Roles[node] == Surroundings::IsLayer;
  };
  PlaceOfNode moving;
  for (const Index node : model.Faces().nodes)
  {
    if (isPlaced(node) && !std::binary_search(choice.Held.begin(), choice.Held.end(), node))
    {
      moving[node] = result.Moved.row(node);
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
  Choice::Result all = choice;
  Points places;
  setMoving(moving, all, places);
  const Surroundings::Result around = this->Around.Spread(model, all, places, options, monitor);
  for (const Index node : model.Faces().nodes)
  {
    if (!isPlaced(node))
    {
      result.Moved.row(node) = around.Moved.row(node);
      result.Roles[node] = around.Roles[node];
    }
  }
}

void InnerNodes::KeepLayers(vtkUnstructuredGrid* grid, const BoundaryModel& model,
  const Choice::Result& choice, const Options& options, Surroundings::Result& result)
{
  const std::vector<std::uint8_t> isLayer = layerCells(grid, options.LayersArray);
  std::string key = std::to_string(model.InputVersion()) + " " +
                    std::to_string(options.KeepLayers) + " " + options.LayersArray;
  if (key != this->LayersKey || this->LayersWall != choice.IsMovingFace)
  {
    this->LayersKey.clear();
    this->Layers = morph::findWallLayers(
      model.Mesh(), model.Faces(), choice.IsMovingFace, options.KeepLayers, isLayer);
    this->LayersWall = choice.IsMovingFace;
    this->LayersKey = std::move(key);
  }
  if (this->Layers.columns.values.empty())
  {
    throw Error("There are no layers to keep: no hexahedra, nor wedges on triangles, lie on the "
                "faces that move" +
                (options.LayersArray.empty()
                    ? std::string(".")
                    : " where the cell array '" + options.LayersArray + "' is not zero.") +
                " Set KeepLayers to 0, or let whole faces of the wall move.");
  }
  morph::moveLayers(model.Points(), model.Faces(), choice.IsMovingFace, this->Layers, result.Moved);
  for (const Index node : this->Layers.columns.values)
  {
    result.Roles[node] = Surroundings::IsLayer;
  }
}

void InnerNodes::MoveRigidly(const Zone& zone, const BoundaryModel& model,
  Surroundings::Result& result, morph::Monitor& monitor)
{
  std::vector<Index> outer;
  for (const Index node : zone.Nodes)
  {
    if (std::binary_search(model.Faces().nodes.begin(), model.Faces().nodes.end(), node) &&
        result.Roles[node] != Surroundings::IsFree)
    {
      outer.push_back(node);
    }
  }
  // Three nodes that are not on a line tell the motion.
  const bool isTold =
    morph::AffineLeastSquares(model.Points()(outer, morph::allColumns)).rank() >= 2;
  const std::vector<Index>& by = isTold ? outer : zone.Edge.empty() ? zone.Nodes : zone.Edge;
  const Points moved = isTold ? result.Moved : this->Guess(model, result, monitor);
  const morph::RigidMotion motion =
    morph::fitRigidMotion(model.Points()(by, morph::allColumns), moved(by, morph::allColumns));
  const bool stays =
    (moved(by, morph::allColumns) - model.Points()(by, morph::allColumns)).isZero(0);
  for (const Index node : zone.Nodes)
  {
    const Eigen::RowVector3d x = model.Points().row(node);
    result.Moved.row(node) = stays ? x : motion(x);
    result.Roles[node] = Surroundings::IsZone;
  }
}

std::vector<Index> InnerNodes::Prescribed(
  const BoundaryModel& model, const Surroundings::Result& result)
{
  std::vector<Index> prescribed;
  for (Index n = 0; n < model.Points().rows(); ++n)
  {
    const bool isOuter =
      std::binary_search(model.Faces().nodes.begin(), model.Faces().nodes.end(), n);
    if (isOuter ? result.Roles[n] != Surroundings::IsFree : result.Roles[n] != Surroundings::Stays)
    {
      prescribed.push_back(n);
    }
  }
  return prescribed;
}

Points InnerNodes::Guess(
  const BoundaryModel& model, const Surroundings::Result& result, morph::Monitor& monitor)
{
  const morph::Mesh& mesh = model.Mesh();
  const std::vector<Index> prescribed = Prescribed(model, result);
  if (!this->Method || this->MethodVersion != model.InputVersion() ||
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
    this->MethodVersion = model.InputVersion();
  }
  Points moved;
  this->Method->evaluate(result.Moved(prescribed, morph::allColumns), moved, monitor);
  return moved;
}

void InnerNodes::Append(vtkUnstructuredGrid* grid, const BoundaryModel& model,
  const Surroundings::Result& result, vtkPolyData* output)
{
  std::vector<Index> nodes;
  for (Index n = 0; n < static_cast<Index>(result.Roles.size()); ++n)
  {
    if ((result.Roles[n] == Surroundings::IsZone || result.Roles[n] == Surroundings::IsLayer) &&
        !std::binary_search(model.Faces().nodes.begin(), model.Faces().nodes.end(), n))
    {
      nodes.push_back(n);
    }
  }
  InnerPoints::Append(grid, nodes, model.Points()(nodes, morph::allColumns),
    result.Moved(nodes, morph::allColumns), result.Roles, output);
}
}
