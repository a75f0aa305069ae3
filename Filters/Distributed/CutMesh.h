// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/DistributedMesh.h"

#include "Mesh/NodePartition.h"
#include "Mesh/PolyhedronPieces.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace morph::distributed
{
/// A distributed mesh whose polyhedra, and cells at divided faces (HangingNodes.h), are cut as
/// PolyhedronPieces does: each rank cuts the cells that it owns, and the pieces are a distributed
/// mesh of their own. Nodes keep their ids. Centers have ids beyond these; the center of a face
/// between two ranks has one id on both. The first piece of a cell has the id of the cell.
/// The constructor is collective.
class CutMesh : public CellPieces
{
public:
  /// `mesh`: that of `whole`, at any points. `whole` has to outlive this object. `layers`: of
  /// ghosts around the pieces. Throws Error on all ranks.
  CutMesh(const DistributedMesh& whole, const Mesh& mesh, int layers, Monitor& monitor);

  const DistributedMesh& whole() const { return *this->whole_; }
  const DistributedMesh& pieces() const { return *this->pieces_; }
  const Mesh& mesh() const override { return this->pieces_->mesh(); }
  std::shared_ptr<const Communicator> processes() const override;
  Index cellOf(Index piece) const override
  {
    return piece < static_cast<Index>(this->cellOf_.size()) ? this->cellOf_[piece] : -1;
  }
  Index nodeOf(Index node) const override { return this->nodeOf_[node]; }
  Points extend(const ConstPoints& points) const override;
  Points reduce(const Points& all, Points points) const override;
  Points extendTranspose(const ConstPoints& all) const override;
  NodePartition extend(const NodePartition& partition) const override;
  std::vector<double> extend(const std::vector<double>& values) const override;

private:
  Piece ownPieces(const Points& points);
  std::vector<std::int64_t> idsOfNodes(const std::vector<std::uint8_t>& isAtGhost) const;
  std::vector<std::int64_t> agreeOnFaces(
    const std::vector<Index>& centers, std::int64_t firstId) const;

  const DistributedMesh* whole_;
  std::unique_ptr<const PolyhedronPieces> cut_; ///< of all local cells of the whole mesh
  std::unique_ptr<DistributedMesh> pieces_;
  std::vector<Index> nodeOf_; ///< #local nodes of the whole mesh
  std::vector<Index> nodes_;  ///< of each of this rank's nodes of pieces that of cut_
  std::vector<Index> cellOf_; ///< of each of this rank's pieces
};
}
