// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Distributed/WholeVolume.h"

#include "Boundary/WallLayers.h"
#include "Private/Distributed/RankMesh.h"

#include <algorithm>

namespace morph::filters
{
using morph::Index;
using morph::distributed::DistributedMesh;

WholeVolume::WholeVolume(const WholeSurface& surface)
  : Surface(surface)
{
}

const morph::Mesh& WholeVolume::piece() const
{
  return this->Surface.Pieces().Grid();
}

const morph::Mesh& WholeVolume::mesh() const
{
  return this->Surface.Pieces().Whole().mesh();
}

const morph::HangingNodes& WholeVolume::hanging() const
{
  return this->Surface.Pieces().Rest()->hanging();
}

bool WholeVolume::needsPieces() const
{
  return this->Surface.Pieces().Rest()->needsPieces();
}

const std::shared_ptr<const morph::Communicator>& WholeVolume::processes() const
{
  return this->Surface.Pieces().Rest()->processes();
}

Index WholeVolume::nodeOf(Index node) const
{
  return this->Surface.Pieces().Whole().nodeOf(this->Surface.Boundary().NodeIds[node]);
}

InnerPieces::Flags WholeVolume::anyFlags(const Flags& ofPiece) const
{
  const DistributedMesh& mesh = this->Surface.Pieces().Whole();
  std::vector<Index> nodes;
  for (std::size_t n = 0; n < ofPiece.size(); ++n)
  {
    if (ofPiece[n] != 0) // by ids: ghost cells of the piece may have points of their own
    {
      nodes.push_back(mesh.nodeOf(mesh.nodeId(static_cast<Index>(n))));
    }
  }
  this->Surface.Pieces().All().spread(nodes);
  Flags result(mesh.pieceNodes(), 0);
  for (const Index node : nodes)
  {
    if (node < mesh.pieceNodes())
    {
      result[node] = 1;
    }
  }
  return result;
}

void WholeVolume::together(const std::function<void()>& work) const
{
  this->Surface.Together(work);
}

InnerPieces::Flags WholeVolume::nodeFlags(const Flags& ofPiece) const
{
  return this->Surface.AnyFlags(ofPiece);
}

std::vector<Index> WholeVolume::ownInner(const Flags& ofPiece) const
{
  const DistributedMesh& mesh = this->Surface.Pieces().Whole();
  const std::vector<Index>& outer = this->Surface.Pieces().Rest()->outerNodes().nodes;
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
  const std::vector<Index>& nodes = rest.outerNodes().nodes;
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
}
