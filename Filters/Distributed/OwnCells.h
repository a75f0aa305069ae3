// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/DistributedMesh.h"
#include "Distributed/RankCommunicator.h"

#include "Mesh/NodePartition.h"
#include "Mesh/SubMesh.h"

#include <cstdint>
#include <vector>

namespace morph::distributed
{
/// The volume cells of a distributed mesh that a rank owns, as a mesh of its own: what code of one
/// mesh and a Communicator works on. No polyhedra.
class OwnCells
{
public:
  /// `partition`: of the local mesh. Holds `mesh` by reference. Not collective.
  OwnCells(const DistributedMesh& mesh, const NodePartition& partition);

  Mesh& mesh() { return this->part_.mesh; }
  const Mesh& mesh() const { return this->part_.mesh; }
  const std::vector<std::int8_t>& orientation() const { return this->orientation_; }
  const NodePartition& partition() const { return this->partition_; }
  const RankCommunicator& communicator() const { return this->communicator_; }

  /// Returns the rows of these nodes; `all`: of all local nodes.
  Points take(const Points& all) const { return all(this->part_.nodes, allColumns); }
  /// The local nodes of the distributed mesh, by this mesh's numbers.
  const std::vector<Index>& nodes() const { return this->part_.nodes; }
  /// The bodies of the whole mesh that these nodes and cells belong to.
  ConnectedComponents bodies() const;
  /// The outer faces of the whole mesh that belong to these cells.
  BoundaryFaces outerFaces() const;
  /// Returns the global ids of these cells of all ranks, ascending. Collective.
  std::vector<Index> gatherIds(const std::vector<Index>& cells) const;

private:
  const DistributedMesh& whole_;
  SubMesh part_;
  std::vector<std::int8_t> orientation_;
  NodePartition partition_;
  RankCommunicator communicator_;
};
}
