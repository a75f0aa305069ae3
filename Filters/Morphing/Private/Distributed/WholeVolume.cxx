// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Distributed/WholeVolume.h"

#include "Boundary/WallLayers.h"
#include "Distributed/RankCommunicator.h"
#include "LinearMethods/SlidingWarp.h"
#include "Mesh/NodePartition.h"
#include "Mesh/Polyhedra.h"
#include "Morpher/PolyhedralMorpher.h"
#include "Private/Distributed/RankMesh.h"

#include <algorithm>
#include <memory>
#include <utility>

namespace morph::filters
{
using morph::Index;
using morph::distributed::DistributedMesh;

namespace
{
morph::NodePartition partitionOf(const DistributedMesh& mesh, const std::vector<Index>& prescribed)
{
  morph::NodePartition partition;
  mesh.ranks().together([&] { partition = morph::partitionNodes(mesh.mesh(), prescribed); });
  return partition;
}
}

WholeVolume::WholeVolume(const WholeSurface& surface)
  : Surface(surface)
{
}

const morph::Mesh& WholeVolume::piece() const
{
  return this->Surface.Pieces().Grid();
}

InnerPieces::Flags WholeVolume::anyFlags(const Flags& ofPiece) const
{
  const DistributedMesh& mesh = this->Surface.Pieces().Whole();
  std::vector<std::int64_t> isUnmarked(mesh.mesh().numberOfNodes(), 1);
  // By ids: ghost cells of the piece may have points of their own.
  const auto nodeOf = [&](std::size_t point)
  { return mesh.nodeOf(mesh.nodeId(static_cast<Index>(point))); };
  for (std::size_t n = 0; n < ofPiece.size(); ++n)
  {
    if (ofPiece[n] != 0)
    {
      isUnmarked[nodeOf(n)] = 0;
    }
  }
  mesh.halo().minimum(mesh.ranks(), isUnmarked);
  Flags result(mesh.pieceNodes(), 0);
  for (std::size_t n = 0; n < result.size(); ++n)
  {
    result[n] = isUnmarked[nodeOf(n)] == 0;
  }
  return result;
}

void WholeVolume::together(const std::function<void()>& work) const
{
  this->Surface.Together(work);
}

bool WholeVolume::anywhere(bool here) const
{
  return this->Surface.Pieces().Ranks().sum(Index(here)) > 0;
}

InnerPieces::Flags WholeVolume::nodeFlags(const Flags& ofPiece) const
{
  return this->Surface.AnyFlags(ofPiece);
}

std::vector<Index> WholeVolume::ownInner(const Flags& ofPiece) const
{
  const DistributedMesh& mesh = this->Surface.Pieces().Whole();
  const std::vector<Index>& outer = mesh.outerNodes().nodes;
  std::vector<Index> points;
  for (Index n = 0; n < static_cast<Index>(ofPiece.size()); ++n)
  {
    if (ofPiece[n] != 0 && mesh.owns(n) && !std::binary_search(outer.begin(), outer.end(), n))
    {
      points.push_back(n);
    }
  }
  return points;
}

InnerPieces::Columns WholeVolume::findLayers(
  const Flags& isWall, Index most, const Flags& isLayer) const
{
  const DistributedMesh& mesh = this->Surface.Pieces().Whole();
  const morph::UndeformedMesh& rest = *this->Surface.Pieces().Rest();
  Flags isOwnWall;
  for (const Index face : rest.boundary().numberOfOwn())
  {
    isOwnWall.push_back(isWall[face]);
  }
  const morph::WallLayers layers =
    morph::findWallLayers(rest.mesh(), rest.outerFaces(), isOwnWall, most, isLayer, rest.all());
  struct Pair
  {
    std::int64_t node, wall;
  };
  Columns columns;
  std::vector<Pair> outer;
  const std::vector<Index>& nodes = mesh.outerNodes().nodes;
  for (std::size_t i = 0; i < layers.walls.size(); ++i)
  {
    const auto column = static_cast<Index>(i);
    for (const Index* n = layers.columns.begin(column); n != layers.columns.end(column); ++n)
    {
      if (std::binary_search(nodes.begin(), nodes.end(), *n))
      {
        outer.push_back({ mesh.nodeId(*n), layers.walls[i] });
      }
      else
      {
        columns.points.emplace_back(*n, this->Surface.Boundary().NodeOf(layers.walls[i]));
      }
    }
  }
  for (const Pair& pair : mesh.ranks().gather(outer))
  {
    columns.nodes.emplace_back(
      this->Surface.Boundary().NodeOf(pair.node), this->Surface.Boundary().NodeOf(pair.wall));
  }
  return columns;
}

std::vector<Index> WholeVolume::Place(const Prescribed& given, morph::Points& places) const
{
  const DistributedMesh& mesh = this->Surface.Pieces().Whole();
  std::vector<Index> prescribed = given.points;
  places = mesh.mesh().points;
  places(prescribed, morph::allColumns) = given.pointPlaces;
  for (std::size_t i = 0; i < given.nodes.size(); ++i)
  {
    const Index node = mesh.nodeOf(this->Surface.Boundary().NodeIds[given.nodes[i]]);
    if (node >= 0)
    {
      prescribed.push_back(node);
      places.row(node) = given.nodePlaces.row(static_cast<Index>(i));
    }
  }
  morph::distributed::RankCommunicator(mesh).spread(prescribed);
  mesh.halo().update(mesh.ranks(), places);
  return prescribed;
}

InnerPieces::Moved WholeVolume::warp(
  const Prescribed& given, const Flags& ofPiece, morph::Monitor& monitor) const
{
  const DistributedMesh& mesh = this->Surface.Pieces().Whole();
  morph::Points places;
  const std::vector<Index> prescribed = this->Place(given, places);
  const auto processes = std::make_shared<morph::distributed::RankCommunicator>(mesh);
  std::unique_ptr<morph::Morpher> method = std::make_unique<morph::FemWarp>();
  if (this->anywhere(morph::hasPolyhedra(this->piece())))
  {
    method = morph::morpherForPolyhedra(std::move(method));
  }
  method->prepare(mesh.mesh(), partitionOf(mesh, prescribed), monitor, processes);
  morph::Points moved;
  method->evaluate(places(prescribed, morph::allColumns), moved, monitor);
  std::vector<Index> flagged;
  for (Index n = 0; n < static_cast<Index>(ofPiece.size()); ++n)
  {
    if (ofPiece[n] != 0)
    {
      flagged.push_back(n);
    }
  }
  return { processes->gather(mesh.mesh().points, flagged), processes->gather(moved, flagged) };
}

std::vector<morph::NodeSliding::Round> WholeVolume::slide(const Prescribed& given,
  const std::vector<Index>& sliding, const morph::NodeSliding::Surfaces& surfaces,
  const morph::NodeSliding::Limits& limits, morph::Points& places, morph::Monitor& monitor) const
{
  const DistributedMesh& mesh = this->Surface.Pieces().Whole();
  morph::Points moved;
  const std::vector<Index> prescribed = this->Place(given, moved);
  std::vector<std::pair<Index, Index>> local; // node of the distributed mesh, index
  for (std::size_t i = 0; i < sliding.size(); ++i)
  {
    const Index node = mesh.nodeOf(this->Surface.Boundary().NodeIds[sliding[i]]);
    if (node >= 0)
    {
      local.emplace_back(node, static_cast<Index>(i));
      moved.row(node) = places.row(static_cast<Index>(i));
    }
  }
  std::sort(local.begin(), local.end());
  std::vector<Index> nodes;
  for (const auto& [node, index] : local)
  {
    nodes.push_back(node);
  }
  const auto processes = std::make_shared<morph::distributed::RankCommunicator>(mesh);
  morph::SlidingWarp method;
  method.prepare(mesh.mesh(), partitionOf(mesh, prescribed), monitor, processes);
  const morph::NodeSliding::Surfaces ofLocal = { [&](Index i, const morph::NodeSliding::Row& x)
    { return surfaces.directions(local[i].second, x); },
    [&](Index i, const morph::NodeSliding::Row& x)
    { return surfaces.closest(local[i].second, x); } };
  const auto done = method.slide(nodes, ofLocal, limits, moved, monitor);
  places = processes->gather(moved, nodes); // in the order of the nodes' ids, as `sliding` is
  return done;
}
}
