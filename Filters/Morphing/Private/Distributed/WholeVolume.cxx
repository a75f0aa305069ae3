// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Distributed/WholeVolume.h"

#include "Distributed/RankCommunicator.h"
#include "Distributed/WallLayers.h"
#include "LinearMethods/SlidingWarp.h"
#include "Mesh/NodePartition.h"
#include "Mesh/Polyhedra.h"
#include "Private/Distributed/RankMesh.h"
#include "Support/Error.h"

#include <algorithm>
#include <string>

namespace morph::filters
{
using morph::Index;
using morph::distributed::DistributedMesh;

namespace
{
/// A row of positions by the global id of its node.
struct Record
{
  std::int64_t id;
  double from[3], to[3];
};

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

void WholeVolume::requireNoPolyhedra(const char* what) const
{
  if (this->Surface.Pieces().Ranks().sum(Index(morph::hasPolyhedra(this->piece()))) > 0)
  {
    throw morph::Error(std::string(what) +
                       " of a mesh with polyhedra needs one MPI rank, and the mesh is distributed "
                       "over several. Run on one.");
  }
}

InnerPieces::Columns WholeVolume::findLayers(
  const Flags& isWall, Index most, const Flags& isLayer) const
{
  const DistributedMesh& mesh = this->Surface.Pieces().Whole();
  const morph::BoundaryFaces &all = this->Surface.Faces(), &own = mesh.outerFaces();
  using Side = std::pair<std::int64_t, int>;
  std::vector<Side> sides; // ascending, as cells are in the order of their ids
  for (std::size_t f = 0; f < all.cells.size(); ++f)
  {
    sides.emplace_back(this->Surface.CellIds()[all.cells[f]], all.sides[f]);
  }
  Flags isOwnWall;
  for (std::size_t f = 0; f < own.cells.size(); ++f)
  {
    const Side side(mesh.cellId(own.cells[f]), own.sides[f]);
    isOwnWall.push_back(isWall[std::lower_bound(sides.begin(), sides.end(), side) - sides.begin()]);
  }
  const std::vector<std::int64_t> wallOf =
    morph::distributed::findWallLayers(mesh, isOwnWall, most, isLayer);

  struct Pair
  {
    std::int64_t node, wall;
  };
  Columns columns;
  std::vector<Pair> outer;
  for (const Index n : mesh.outerNodes().nodes)
  {
    if (wallOf[n] >= 0 && mesh.owns(n))
    {
      outer.push_back({ mesh.nodeId(n), wallOf[n] });
    }
  }
  for (const Pair& pair : mesh.ranks().gather(outer))
  {
    columns.nodes.emplace_back(this->Surface.NodeOf(pair.node), this->Surface.NodeOf(pair.wall));
  }
  Flags isInColumn(mesh.pieceNodes(), 0);
  for (std::size_t n = 0; n < isInColumn.size(); ++n)
  {
    isInColumn[n] = wallOf[n] >= 0;
  }
  for (const Index n : this->ownInner(isInColumn))
  {
    columns.points.emplace_back(n, this->Surface.NodeOf(wallOf[n]));
  }
  return columns;
}

std::vector<Index> WholeVolume::Place(const Prescribed& given, morph::Points& places) const
{
  const DistributedMesh& mesh = this->Surface.Pieces().Whole();
  std::vector<std::int64_t> isFree(mesh.mesh().numberOfNodes(), 1);
  places = mesh.mesh().points;
  for (std::size_t i = 0; i < given.nodes.size(); ++i)
  {
    const Index node = mesh.nodeOf(this->Surface.NodeIds()[given.nodes[i]]);
    if (node >= 0)
    {
      isFree[node] = 0;
      places.row(node) = given.nodePlaces.row(static_cast<Index>(i));
    }
  }
  for (std::size_t i = 0; i < given.points.size(); ++i)
  {
    isFree[given.points[i]] = 0;
    places.row(given.points[i]) = given.pointPlaces.row(static_cast<Index>(i));
  }
  mesh.halo().minimum(mesh.ranks(), isFree);
  mesh.halo().update(mesh.ranks(), places);
  std::vector<Index> prescribed;
  for (std::size_t n = 0; n < isFree.size(); ++n)
  {
    if (isFree[n] == 0)
    {
      prescribed.push_back(static_cast<Index>(n));
    }
  }
  return prescribed;
}

InnerPieces::Moved WholeVolume::warp(
  const Prescribed& given, const Flags& ofPiece, morph::Monitor& monitor) const
{
  const DistributedMesh& mesh = this->Surface.Pieces().Whole();
  morph::Points places;
  const std::vector<Index> prescribed = this->Place(given, places);
  morph::FemWarp method;
  method.prepare(mesh.mesh(), partitionOf(mesh, prescribed), monitor,
    std::make_shared<morph::distributed::RankCommunicator>(mesh));
  morph::Points moved;
  method.evaluate(places(prescribed, morph::allColumns), moved, monitor);
  std::vector<Record> records;
  for (Index n = 0; n < static_cast<Index>(ofPiece.size()); ++n)
  {
    if (ofPiece[n] != 0 && mesh.owns(n))
    {
      const Eigen::RowVector3d from = mesh.mesh().points.row(n), to = moved.row(n);
      records.push_back({ mesh.nodeId(n), { from[0], from[1], from[2] }, { to[0], to[1], to[2] } });
    }
  }
  records = mesh.ranks().gather(records);
  std::sort(
    records.begin(), records.end(), [](const Record& a, const Record& b) { return a.id < b.id; });
  Moved result;
  result.from.resize(static_cast<Index>(records.size()), 3);
  result.to.resize(result.from.rows(), 3);
  for (std::size_t i = 0; i < records.size(); ++i)
  {
    const auto row = static_cast<Index>(i);
    result.from.row(row) = Eigen::Map<const Eigen::RowVector3d>(records[i].from);
    result.to.row(row) = Eigen::Map<const Eigen::RowVector3d>(records[i].to);
  }
  return result;
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
    const Index node = mesh.nodeOf(this->Surface.NodeIds()[sliding[i]]);
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
  morph::SlidingWarp method;
  method.prepare(mesh.mesh(), partitionOf(mesh, prescribed), monitor,
    std::make_shared<morph::distributed::RankCommunicator>(mesh));
  const morph::NodeSliding::Surfaces ofLocal = { [&](Index i, const morph::NodeSliding::Row& x)
    { return surfaces.directions(local[i].second, x); },
    [&](Index i, const morph::NodeSliding::Row& x)
    { return surfaces.closest(local[i].second, x); } };
  const auto done = method.slide(nodes, ofLocal, limits, moved, monitor);
  struct Place
  {
    Index index;
    double x[3];
  };
  std::vector<Place> own;
  for (const auto& [node, index] : local)
  {
    if (mesh.owns(node))
    {
      own.push_back({ index, { moved(node, 0), moved(node, 1), moved(node, 2) } });
    }
  }
  for (const Place& place : mesh.ranks().gather(own))
  {
    places.row(place.index) = Eigen::Map<const Eigen::RowVector3d>(place.x);
  }
  return done;
}
}
