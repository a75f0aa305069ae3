// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/HangingNodes.h"
#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"
#include "Support/Communicator.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace morph
{
/// The inner nodes of a mesh whose cells several processes have. Each process has all nodes of the
/// boundary, which are called nodes here; each inner node is a point of the process that owns it.
/// Functions are collective, but for those that say that they are not.
class InnerPieces
{
public:
  using Flags = std::vector<std::uint8_t>;
  virtual ~InnerPieces();

  /// Of this process, with its ghost cells. Not collective, as the next three.
  virtual const Mesh& piece() const = 0;
  /// The same for methods: its points come first, and then copies of what is around them.
  virtual const Mesh& mesh() const = 0;
  /// What hangs in mesh(), and whether methods work on pieces of its cells on any process.
  ///@{
  virtual const HangingNodes& hanging() const = 0;
  virtual bool needsPieces() const = 0;
  ///@}
  /// Those that have the other parts of mesh().
  virtual const std::shared_ptr<const Communicator>& processes() const = 0;
  /// The node of mesh() that a node is, or -1.
  virtual Index nodeOf(Index node) const = 0;
  /// Calls `work`, the same on each process, which must not communicate; throws on all where it
  /// throws on one.
  virtual void together(const std::function<void()>& work) const = 0;
  /// Whether it is so on any process.
  bool anywhere(bool here) const { return !this->processes()->all(!here); }
  /// Whether any process flags a node of the boundary. `ofPiece`: #points of the piece, or empty.
  virtual Flags nodeFlags(const Flags& ofPiece) const = 0;
  /// Whether any process flags a point of the piece.
  virtual Flags anyFlags(const Flags& ofPiece) const = 0;
  /// The flagged points of the piece inside the mesh that this process owns, ascending. Not
  /// collective.
  virtual std::vector<Index> ownInner(const Flags& ofPiece) const = 0;

  struct Columns
  {
    /// each with the node of its wall
    std::vector<std::pair<Index, Index>> nodes;  ///< of the boundary, all processes
    std::vector<std::pair<Index, Index>> points; ///< ownInner()
  };
  /// findWallLayers(). `faces`: of the boundary, inner ones too; `isWall`: of these; `isLayer`: of
  /// the piece's cells, or empty for all.
  virtual Columns findLayers(
    const BoundaryFaces& faces, const Flags& isWall, Index most, const Flags& isLayer) const = 0;

  /// Where nodes and own inner points are that a method prescribes.
  struct Prescribed
  {
    std::vector<Index> nodes, points;
    Points nodePlaces, pointPlaces;
  };
  /// Returns the nodes of mesh() that are prescribed, and their places. `places`: becomes #nodes x
  /// 3.
  std::vector<Index> place(const Prescribed& given, Points& places) const;
};
}
