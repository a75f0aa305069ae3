// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/NodePartition.h"
#include "Mesh/Topology.h"
#include "Support/Communicator.h"
#include "Support/Monitor.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace morph
{
/// A part of a mesh as a mesh of its own, so that work on it costs nothing elsewhere. Nodes and
/// cells keep their order.
struct SubMesh
{
  /// `cells`: ids of the part's cells, ascending, no polyhedra. Cost: a pass over the nodes.
  SubMesh(const Mesh& whole, const std::vector<Index>& cells);

  Mesh mesh;
  std::vector<Index> nodes; ///< their ids in the whole mesh, ascending
  std::vector<Index> cells; ///< their ids in the whole mesh, ascending

  /// Returns the numbers here of nodes of the whole mesh, -1 for those outside. `ids`: ascending.
  std::vector<Index> numbersOf(const std::vector<Index>& ids) const;
  /// Returns the part's own of `values`, one a cell of the whole mesh.
  template <typename Value>
  std::vector<Value> take(const std::vector<Value>& values) const
  {
    std::vector<Value> own;
    for (const Index c : this->cells)
    {
      own.push_back(values[c]);
    }
    return own;
  }
};

/// The volume cells of a mesh that are no copies of another process's cells, as a mesh of its own:
/// what code of one mesh and a Communicator works on. One process has its whole mesh. No polyhedra
/// on several.
class OwnCells
{
public:
  /// `partition`, `orientation`: of `mesh`, which holds this process's cells and copies around
  /// them. Holds `processes` by reference. Not collective.
  OwnCells(Mesh mesh, const NodePartition& partition, const std::vector<std::int8_t>& orientation,
    const Communicator& processes);

  bool isWhole() const { return this->isWhole_; }
  Mesh& mesh() { return this->part_.mesh; }
  const Mesh& mesh() const { return this->part_.mesh; }
  const std::vector<std::int8_t>& orientation() const { return this->orientation_; }
  const NodePartition& partition() const { return this->partition_; }
  const Communicator& communicator() const { return *this->communicator_; }

  /// Returns the rows of these nodes; `all`: of all nodes.
  Points take(const Points& all) const { return all(this->part_.nodes, allColumns); }
  /// These nodes, by the numbers of the mesh.
  const std::vector<Index>& nodes() const { return this->part_.nodes; }
  /// The bodies that these nodes and cells belong to. `ofMesh`: those of the mesh.
  ConnectedComponents bodies(const ConnectedComponents& ofMesh) const;
  /// The outer faces of these cells. `mesh`: as before. Cost: boundaryFaces().
  BoundaryFaces outerFaces(const Mesh& mesh, Monitor& monitor) const;
  /// Returns the numbers in the whole mesh of these cells of all processes, ascending. Collective.
  std::vector<Index> gatherIds(const std::vector<Index>& cells) const;

  /// Nonzero for the cells that are left out; empty for one process. Not collective.
  static std::vector<std::uint8_t> others(const Mesh& mesh, const Communicator& processes);

private:
  const Communicator& processes_;
  bool isWhole_;
  SubMesh part_;
  std::vector<std::int8_t> orientation_;
  NodePartition partition_;
  std::unique_ptr<Communicator> communicator_;
};
}
