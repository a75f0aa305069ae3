// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LinearMethods/NodeSliding.h"
#include "Mesh/Mesh.h"
#include "Support/Monitor.h"

#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

namespace morph
{
/// The inner nodes of a mesh whose cells several processes have. Each process has all nodes of the
/// boundary, which are called nodes here; each inner node is a point of the process that owns it.
/// All functions but the first and ownInner() are collective.
class InnerPieces
{
public:
  using Flags = std::vector<std::uint8_t>;
  virtual ~InnerPieces();

  virtual const Mesh& piece() const = 0; ///< of this process, with its ghost cells
  /// Calls `work`, the same on each process, which must not communicate; throws on all where it
  /// throws on one.
  virtual void together(const std::function<void()>& work) const = 0;
  /// Whether it is so on any process.
  virtual bool anywhere(bool here) const = 0;
  /// Whether any process flags a node of the boundary. `ofPiece`: #points of the piece, or empty.
  virtual Flags nodeFlags(const Flags& ofPiece) const = 0;
  /// Whether any process flags a point of the piece.
  virtual Flags anyFlags(const Flags& ofPiece) const = 0;
  /// The flagged points of the piece inside the mesh that this process owns, ascending.
  virtual std::vector<Index> ownInner(const Flags& ofPiece) const = 0;

  struct Columns
  {
    /// each with the node of its wall
    std::vector<std::pair<Index, Index>> nodes;  ///< of the boundary, all processes
    std::vector<std::pair<Index, Index>> points; ///< ownInner()
  };
  /// findWallLayers(). `isWall`: of the boundary's faces; `isLayer`: of the piece's cells, or empty
  /// for all.
  virtual Columns findLayers(const Flags& isWall, Index most, const Flags& isLayer) const = 0;

  /// Where nodes and own inner points are that a method prescribes.
  struct Prescribed
  {
    std::vector<Index> nodes, points;
    Points nodePlaces, pointPlaces;
  };
  struct Moved
  {
    Points from, to;
  };
  /// Where FEMWARP takes the flagged points of all pieces, each once, in the order of global ids.
  /// Cost: that of FEMWARP, and 56 bytes a point on every process.
  virtual Moved warp(const Prescribed& given, const Flags& ofPiece, Monitor& monitor) const = 0;

  /// SlidingWarp. `sliding`: nodes, ascending; `surfaces`: by their index; `places`: of `sliding`,
  /// become those after the rounds on all processes.
  virtual std::vector<NodeSliding::Round> slide(const Prescribed& given,
    const std::vector<Index>& sliding, const NodeSliding::Surfaces& surfaces,
    const NodeSliding::Limits& limits, Points& places, Monitor& monitor) const = 0;
};
}
