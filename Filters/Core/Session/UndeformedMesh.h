// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/NodesBetween.h"
#include "Boundary/WholeBoundary.h"
#include "Mesh/HangingNodes.h"
#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"
#include "Morpher/Morpher.h"
#include "Quality/InvertedBefore.h"
#include "Session/BoundaryTargets.h"
#include "Support/Communicator.h"
#include "Support/Monitor.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace morph
{
/// A mesh to be morphed, with what follows from it alone: made once for all motions.
class UndeformedMesh
{
public:
  /// No cells: it cannot be morphed.
  UndeformedMesh() = default;
  /// `mesh`: as validate() wants it. `sameCells`: null, or a mesh with the same cells and other
  /// points. Throws Error as requireVolumeCells(). Cost: the bodies, and the search of the outer
  /// faces unless `sameCells` has them.
  UndeformedMesh(Mesh mesh, const UndeformedMesh* sameCells, Monitor& monitor);
  /// What a process knows of a mesh of which several have parts, each with copies of the cells
  /// around its nodes.
  struct Part
  {
    std::shared_ptr<const Mesh> mesh;
    HangingNodes hanging;     ///< of `mesh`
    bool needsPieces = false; ///< see needsPieces(); of the whole mesh
    double size = 0;          ///< of the whole mesh
    std::shared_ptr<const Communicator> processes;
  };
  /// Of several processes. Collective. Cost: as above.
  UndeformedMesh(Part part, Monitor& monitor);
  UndeformedMesh(const UndeformedMesh&) = delete;

  const Mesh& mesh() const { return *this->mesh_; }
  /// Of several processes, those of this process's own cells.
  const BoundaryFaces& outerFaces() const { return this->outer_; }
  /// Their nodes and what is between them. Of several processes all nodes of this process's own
  /// cells that are outside the whole mesh, and the faces are not those.
  const BoundaryFaces& outerNodes() const
  {
    return this->processes_ ? this->outerNodes_ : this->outer_;
  }
  const HangingNodes& hanging() const { return this->hanging_; }
  /// See meshSize().
  double size() const { return this->size_; }
  /// #cells; see cellSigns().
  const std::vector<std::int8_t>& orientation() const { return this->orientation_; }
  Index mirroredBodies() const { return this->mirrored_; }
  /// The first cell of orientation -1, if there are mirrored bodies.
  Index firstMirrored() const { return this->firstMirrored_; }
  /// Whether a method works on pieces of some cells; see morph::needsPieces().
  bool needsPieces() const { return this->needsPieces_; }
  /// Those that have the other parts of the mesh; null for one process.
  const std::shared_ptr<const Communicator>& processes() const { return this->processes_; }
  /// Those, or this process alone.
  const Communicator& all() const
  {
    return this->processes_ ? *this->processes_ : Communicator::alone();
  }
  /// Cells that are there twice, and nodes where bodies touch by chance; see SharedCorners.h.
  ///@{
  const std::vector<Index>& repeatedCells() const { return this->repeated_; }
  const std::vector<Index>& touchingNodes() const { return this->touching_; }
  ///@}
  const std::vector<Index>& unmappedCells() const { return this->unmapped_; } ///< Certificate.h
  /// The nodes that a method gets as prescribed where the boundary prescribes `ids`, ascending. Not
  /// those that hang, as their ties move them; and all nodes of bodies that have none, which stay.
  std::vector<Index> prescribedFor(const std::vector<Index>& ids) const;
  /// Makes `method` fit for the mesh: on the pieces of polyhedra and of cells at divided faces, one
  /// that reads no cells for each body alone, and as onProcesses() on several. `method`: not
  /// prepared.
  std::unique_ptr<Morpher> fitted(std::unique_ptr<Morpher> method) const;

  /// Copies of other processes' cells count here. Cost of the first call: a measure of the mesh.
  const InvertedBefore& before(Monitor& monitor) const;
  /// nodesOnLinearEdges() of outerFaces(). Cost of the first call: as that.
  const std::vector<Index>& onLinearEdges() const;
  /// The outer faces of all processes. Collective, as is the first call's cost: see WholeBoundary.
  const WholeBoundary& boundary() const;

private:
  void findBodies(Monitor& monitor);
  void findTouching(const BoundaryFaces& faces);

  std::shared_ptr<const Mesh> mesh_ = std::make_shared<Mesh>();
  std::shared_ptr<const Communicator> processes_;
  BoundaryFaces outer_, outerNodes_;
  HangingNodes hanging_;
  std::vector<Index> bodyOfNode_; ///< see bodyOfNodes(); empty for a single body
  double size_ = 0;
  std::vector<std::int8_t> orientation_;
  Index mirrored_ = 0, firstMirrored_ = 0;
  bool needsPieces_ = false;
  std::vector<Index> repeated_, touching_, unmapped_;
  ///@{ once it was asked for
  mutable std::optional<InvertedBefore> before_;
  mutable std::optional<std::vector<Index>> onLinearEdges_;
  mutable std::optional<WholeBoundary> boundary_;
  ///@}
};

/// Warns of `bodies` mirrored bodies, if there are some. `first`: the first cell of orientation -1.
void warnOfMirrored(Index bodies, Index first, Monitor& monitor);
/// Warns of cells that are there twice, and of nodes where bodies touch; see SharedCorners.h. Ids
/// are those of the whole mesh, ascending.
void warnOfShared(const std::vector<Index>& repeatedCells, const std::vector<Index>& touchingNodes,
  Monitor& monitor);
/// Warns of cells that name a corner more than once and are no known shape; see CollapsedCells.h.
/// Ids as above.
void warnOfUnrecognized(const std::vector<Index>& cells, Monitor& monitor);
/// Warns of cells of which quality sees the corners alone; see unmappedCells(). Ids as above.
void warnOfUnmapped(const std::vector<Index>& cells, Monitor& monitor);
/// Returns the prescribed nodes that hang and are not at their targets in the moved mesh, but
/// farther away than 1e-6 of `size`, that of the mesh. `moved`: #nodes x 3.
std::vector<Index> droppedTargets(
  const BoundaryTargets& boundary, const HangingNodes& hanging, const Points& moved, double size);
/// A warning of these, or nothing. `ids`: of the whole mesh, ascending.
std::string noteOfDropped(const std::vector<Index>& ids);
/// Warns of nodes that part from linear cells; see NodesBetween.h. Ids as above.
void warnOfParting(const Parting& parting, Monitor& monitor);
/// Warns of nodes of shells, beams or links that hang on nothing; see AttachedNodes.h. Ids as
/// above.
void warnOfLoose(const std::vector<Index>& nodes, Monitor& monitor);
}
