// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/Directory.h"
#include "Distributed/Halo.h"
#include "Distributed/Piece.h"
#include "Distributed/Ranks.h"

#include "Mesh/HangingNodes.h"
#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"
#include "Support/Monitor.h"

#include <Eigen/Geometry>

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace morph::distributed
{
/// Returns the diagonal of the box around those of all ranks, 0 if they are empty. Collective.
double diagonal(const Ranks& ranks, const Eigen::AlignedBox3d& box);

/// A mesh whose cells are distributed over ranks. Each rank has its piece and, behind it, copies of
/// the other ranks' cells of the highest dimension around the piece's nodes (ghosts). Each node
/// that a cell uses has one owner, the lowest rank that uses it.
///
/// Local numbers: the piece's nodes and cells come first, in the piece's order. A ghost cell of the
/// piece itself is a vertex here, which no method reads.
class DistributedMesh
{
public:
  /// Builds the ghosts. `piece`: with node and cell ids. `layers`: of cells around the piece's
  /// nodes, 1 or more. Throws Error on all ranks where the pieces do not fit together. Collective.
  /// Cost: messages of the size of the interfaces, and a directory of 40 bytes a node. Where faces
  /// are divided on one side alone, every rank gets the cells at the whole boundary: 24 bytes for
  /// each of their nodes, and 8 for each corner.
  DistributedMesh(const Ranks& ranks, Piece piece, int layers, Monitor& monitor);

  /// Moves the nodes alone: bodies, orientation and size stay as they were found.
  /// `points`: #nodes x 3, ghosts as their owners have them. Not collective.
  void setPoints(Points points) { this->mesh_.points = std::move(points); }

  const Ranks& ranks() const { return *this->ranks_; }
  const Mesh& mesh() const { return this->mesh_; }
  Index pieceNodes() const { return this->pieceNodes_; }
  Index pieceCells() const { return this->pieceCells_; }

  /// Gives further copies of a node, as the piece's ghost cells may have them, the row of that
  /// node; #nodes x 3. They take part in nothing else.
  void copyToDoubles(Points& values) const;
  bool owns(Index node) const { return this->owner_[node] == this->ranks_->rank(); }
  /// The rank that owns a node, -1 for none.
  int owner(Index node) const { return this->owner_[node]; }
  /// #cells: nonzero for ghosts.
  const std::vector<std::uint8_t>& isGhost() const { return this->isGhost_; }
  std::int64_t nodeId(Index node) const { return this->nodeIds_[node]; }
  std::int64_t cellId(Index cell) const { return this->cellIds_[cell]; }
  const std::vector<std::int64_t>& nodeIds() const { return this->nodeIds_; }
  const std::vector<std::int64_t>& cellIds() const { return this->cellIds_; }
  /// Global ids of nodes or cells, for messages.
  std::vector<Index> idsOfNodes(const std::vector<Index>& nodes) const;
  /// Returns the local node of a global id, or -1.
  Index nodeOf(std::int64_t id) const;

  const Halo& halo() const { return this->halo_; }
  /// Of cells.
  const Halo& cellHalo() const { return this->cellHalo_; }
  const Directory& directory() const { return *this->directory_; }

  /// Joins the components that ranks have of some nodes where these have a node in common.
  /// `ofNode`: #nodes, -1 for others; becomes numbers from 0 that are the same on all ranks.
  /// Returns how many there are. Collective.
  Index join(std::vector<Index>& ofNode) const;
  /// The bodies of the whole mesh, by the same numbers on all ranks.
  const ConnectedComponents& bodies() const { return this->bodies_; }
  /// cellSigns() of the whole mesh; #cells.
  const std::vector<std::int8_t>& orientation() const { return this->orientation_; }
  /// What hangs in the whole mesh, of the local nodes and cells. What a local node is tied to, and
  /// the nodes on faces and edges of local cells, are local nodes. Cells that a node lies on count
  /// as those around it.
  const HangingNodes& hanging() const { return this->hanging_; }
  /// Whether any rank has nodes that hang, or cells at divided faces.
  bool hasHanging() const { return this->hasHanging_; }
  /// The diagonal of the bounding box of the nodes that cells of the highest dimension use.
  double size() const { return this->size_; }
  /// Volume cells of all ranks.
  Index volumeCells() const { return this->volumeCells_; }

private:
  struct Builder;
  /// Without cells.
  explicit DistributedMesh(const Ranks& ranks)
    : ranks_(&ranks)
  {
    this->mesh_.offsets = { 0 };
  }
  std::vector<NodeRecord> numberNodes();
  void addGhosts(int layers, Monitor& monitor);
  void findHanging(Builder& builder, Monitor& monitor);
  void findBodies(Monitor& monitor);
  void measure();

  const Ranks* ranks_;
  Mesh mesh_;
  Index pieceNodes_ = 0, pieceCells_ = 0;
  std::vector<std::uint8_t> isGhost_;
  std::vector<std::int64_t> nodeIds_, cellIds_;
  std::vector<std::uint8_t> isUsed_; ///< #nodes of the piece, by its own cells
  std::vector<int> owner_;
  std::vector<std::pair<std::int64_t, Index>> byId_; ///< sorted
  std::vector<std::pair<Index, Index>> doubles_;     ///< a node, and the one that stands for it
  std::shared_ptr<const Directory> directory_;
  Halo halo_, cellHalo_;
  ConnectedComponents bodies_;
  std::vector<std::int8_t> orientation_;
  HangingNodes hanging_;
  bool hasHanging_ = false;
  int dimension_ = 0; ///< the highest of cells
  double size_ = 0;
  Index volumeCells_ = 0;
};
}
