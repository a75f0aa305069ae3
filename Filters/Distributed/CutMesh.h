// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/DistributedMesh.h"

#include "Mesh/NodePartition.h"
#include "Mesh/PolyhedronPieces.h"

#include <Eigen/SparseCore>

#include <cstdint>
#include <memory>
#include <vector>

namespace morph::distributed
{
/// A distributed mesh whose polyhedra, and cells at divided faces (HangingNodes.h), are cut as
/// PolyhedronPieces does: each rank cuts the cells that it owns, and the pieces are a distributed
/// mesh of their own. Nodes keep their ids. Centers have ids beyond these; the center of a face
/// between two ranks has one id on both. The first piece of a cell has the id of the cell.
/// Constructor and extend() are collective.
class CutMesh
{
public:
  /// `whole` has to outlive this object. `layers`: of ghosts around the pieces. Throws Error on all
  /// ranks.
  CutMesh(const DistributedMesh& whole, int layers, Monitor& monitor);

  const DistributedMesh& mesh() const { return *this->pieces_; }
  /// The node of the pieces that a node of the whole mesh is; -1 for one that no own cell has.
  Index nodeOf(Index node) const { return this->nodeOf_[node]; }

  /// PolyhedronPieces::extend() for points and displacements. `points`: #local nodes x 3 of the
  /// whole mesh; returns #local nodes x 3 of the pieces, ghosts as their owners have them.
  Points extend(const Points& points) const;
  /// Returns the rows of the nodes without the centers, ghosts as their owners have them: #local
  /// nodes x 3 of the whole mesh. Nodes of no cell keep their row of `points`, of that size.
  /// Collective.
  Points reduce(const Points& all, Points points) const;
  /// The adjoint of extend(): `all` is read at the nodes that this rank owns. Ghosts' rows of the
  /// result are to be added to their owners'. Not collective.
  Points extendTranspose(const Points& all) const;
  /// Of the local nodes; with the owner's choice at ghosts. Nodes that hang on prescribed ones
  /// alone are prescribed, too.
  NodePartition extend(const NodePartition& partition) const;
  /// Returns the values of this rank's pieces; `values`: of the piece's cells. Not collective.
  std::vector<double> extend(const std::vector<double>& values) const;

private:
  using Means = Eigen::SparseMatrix<double, Eigen::RowMajor, int>;

  Piece ownPieces(const PolyhedronPieces& cut);
  void takeMeans(const PolyhedronPieces& cut, const std::vector<Index>& centers);
  void numberCenters(const PolyhedronPieces& cut, const std::vector<Index>& centers,
    const std::vector<std::uint8_t>& isAtGhost, std::vector<std::int64_t>& ids) const;
  void agreeOnFaces(const std::vector<Index>& rows, const PolyhedronPieces& cut,
    std::int64_t firstId, std::vector<std::int64_t>& idOfRow) const;

  const DistributedMesh* whole_;
  std::unique_ptr<DistributedMesh> pieces_;
  std::vector<Index> nodeOf_;    ///< #local nodes of the whole mesh
  std::vector<Index> wholeNode_; ///< of each of this rank's nodes of pieces that is no center
  std::vector<Index> cellOf_;    ///< of each of this rank's pieces
  Index faceCenters_ = 0;        ///< this rank's; they are the first rows of means_
  Means means_;                  ///< #this rank's centers x #local nodes of the whole mesh
};
}
