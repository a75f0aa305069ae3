// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LinearMethods/NodeSliding.h"
#include "Mesh/Mesh.h"
#include "Private/Distributed/WholeSurface.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace morph
{
class Monitor;
}

namespace morph::filters
{
/// The inner nodes of a mesh on several MPI processes, beside its boundary. Every process has the
/// nodes of WholeSurface::Grid(), which are called nodes here. Each inner node is a point of the
/// process that owns it. All functions that say so are collective.
class WholeVolume
{
public:
  /// Holds `surface` by reference, after its Take().
  explicit WholeVolume(const WholeSurface& surface);

  using Flags = std::vector<std::uint8_t>;

  const morph::Mesh& Piece() const; ///< of this process, with its ghost cells
  /// Whether any process flags a node; #points of the piece. Collective.
  Flags AnyFlags(const Flags& ofPiece) const;
  /// The flagged points of the piece inside the mesh that this process owns, ascending.
  std::vector<morph::Index> OwnInner(const Flags& ofPiece) const;
  /// Throws morph::Error on all processes where the mesh has polyhedra. `what` needs one process.
  void RequireNoPolyhedra(const char* what) const;

  struct Columns
  {
    /// each with the node of its wall
    std::vector<std::pair<morph::Index, morph::Index>> Nodes;  ///< of the boundary, all processes
    std::vector<std::pair<morph::Index, morph::Index>> Points; ///< OwnInner()
  };
  /// morph::findWallLayers(). `isWall`: of Grid()'s faces; `isLayer`: of the piece's cells, or
  /// empty for all. Collective.
  Columns FindLayers(const Flags& isWall, morph::Index most, const Flags& isLayer) const;

  /// Where nodes and own inner points are that a method prescribes.
  struct Prescribed
  {
    std::vector<morph::Index> Nodes, Points;
    morph::Points NodePlaces, PointPlaces;
  };
  struct Moved
  {
    morph::Points From, To;
  };
  /// Where FEMWARP takes the flagged points of all pieces, each once, in the order of global ids.
  /// Collective. Cost: that of FEMWARP, and 56 bytes a point on every process.
  Moved Warp(const Prescribed& given, const Flags& ofPiece, morph::Monitor& monitor) const;

  /// morph::SlidingWarp. `sliding`: nodes, ascending; `surfaces`: by their index; `places`: of
  /// `sliding`, become those after the rounds on all processes. Collective.
  std::vector<morph::NodeSliding::Round> Slide(const Prescribed& given,
    const std::vector<morph::Index>& sliding, const morph::NodeSliding::Surfaces& surfaces,
    int rounds, morph::Points& places, morph::Monitor& monitor) const;

private:
  /// The nodes of the distributed mesh that are prescribed, and the places of all. Collective.
  std::vector<morph::Index> Place(const Prescribed& given, morph::Points& places) const;

  const WholeSurface& Surface;
};
}
