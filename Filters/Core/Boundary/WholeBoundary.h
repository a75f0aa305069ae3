// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"
#include "Support/Communicator.h"
#include "Support/Monitor.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace morph
{
/// The outer faces of a mesh of which each process has a part: whole, and the same on each process.
/// Its nodes are in the order of their ids, its faces in that of cells and sides: those of one
/// process that has the whole mesh.
class WholeBoundary
{
public:
  /// `own`: the outer faces of this process's own cells, by nodes of `mesh`. `orientation`: #cells
  /// (cellSigns()). Holds `processes` by reference. Collective. Cost: a sort of the faces. On every
  /// process 40 bytes for each face and node of all, and 8 for each of their corners.
  WholeBoundary(const Mesh& mesh, const BoundaryFaces& own,
    const std::vector<std::int8_t>& orientation, const Communicator& processes);

  /// By the numbers of the nodes here; the cell behind each face has the number of the face.
  const BoundaryFaces& faces() const { return this->faces_; }
  const std::vector<std::int8_t>& orientation() const { return this->orientation_; } ///< #faces
  /// #faces: the cell behind each, by its number in the whole mesh.
  const std::vector<Index>& cells() const { return this->cells_; }
  /// #nodes: their numbers in the whole mesh, ascending.
  const std::vector<Index>& nodes() const { return this->nodes_; }
  const Points& rest() const { return this->rest_; } ///< #nodes x 3, of the mesh's own points
  std::size_t bytes() const { return this->bytes_; } ///< that each process has for it from all
  /// Of each face of `own` its number here.
  const std::vector<Index>& numberOfOwn() const { return this->numberOfOwn_; }

  /// Returns the rows of the nodes, #nodes x 3. `rows`: of the nodes of `mesh`; the last ones may
  /// be left out if another process has these. Collective.
  Points gather(const ConstPoints& rows) const;
  /// Whether each node is in the list of a process. `nodes`: of `mesh`, ascending. Collective.
  std::vector<char> isAmong(const std::vector<Index>& nodes) const;
  /// crossingFaces() among `some` of its faces, for the nodes at `moved`, #nodes x 3. Collective.
  std::vector<std::array<Index, 2>> crossings(
    const BoundaryFaces& some, const Points& moved, Monitor& monitor) const;

private:
  const Communicator& processes_;
  std::vector<Index> own_;       ///< nodes of `mesh` on this process's faces
  std::vector<Index> ownNumber_; ///< of each its number here
  BoundaryFaces faces_;
  std::vector<std::int8_t> orientation_;
  std::vector<Index> cells_, nodes_, numberOfOwn_;
  Points rest_;
  std::size_t bytes_ = 0;
};
}
