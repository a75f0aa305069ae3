// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/NodePartition.h"
#include "Mesh/Topology.h"
#include "Support/Monitor.h"

#include <Eigen/SparseCore>

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace morph
{
/// Faces that are divided on one side alone, as where a cell meets cells of half its size (2:1
/// refinement, octree meshes). Faces of other cells then lie in one, have its corners, and fill it.
/// All of them are inside the mesh. The nodes of the small faces that are no corners of the large
/// one hang. They are tied to its corners by the shape functions at their place, or to the ends of
/// an edge if they lie on it. So no gap opens. A tie to a node that hangs, too, is one to what that
/// is tied to.
///
/// Cells are linear: tetrahedra, hexahedra, wedges and pyramids. A mesh with polyhedra has none, as
/// these have the small faces themselves.
class HangingNodes
{
public:
  /// Finds them among the faces that one cell alone has. Returns for each whether it is inside; an
  /// empty list means that none is. Cost: a pass over the faces, a microsecond each.
  std::vector<std::uint8_t> find(const Mesh& mesh, const BoundaryFaces& faces, Monitor& monitor);

  /// Whether no face is divided on one side alone.
  bool empty() const { return this->covers_.empty(); }
  /// The nodes that hang, ascending. There may be none where a face is only cut.
  const std::vector<Index>& nodes() const { return this->ids_; }
  bool hangs(Index node) const;
  /// Returns the partition for a method on conforming(): nodes that hang on prescribed nodes alone
  /// are prescribed, too. `partition`: of the mesh, where the nodes that hang are free.
  NodePartition extend(NodePartition partition) const;
  /// Gives large faces the nodes that hang on their edges as corners, as the small ones beside them
  /// have these, so that neighbors share edges.
  void divideEdges(BoundaryFaces& faces) const;
  /// Returns the ids of nodes that do not hang.
  std::vector<Index> without(const std::vector<Index>& ids) const;

  /// Fills the rows of `displacement`, #nodes x 3, of nodes that hang from those of the others.
  void apply(Points& displacement) const;
  /// The adjoint of apply(): adds their rows to those of the others, and sets them to zero.
  void applyTranspose(Points& gradient) const;
  /// Places them in a moved mesh. `rest`, `moved`: #nodes x 3.
  void place(const Points& rest, Points& moved) const;

  /// Returns the mesh with polyhedra for the cells at divided faces and edges, so that neighbors
  /// have equal faces. Ids of nodes and cells stay. `mesh`: that of find(), with these or other
  /// points.
  Mesh conforming(const Mesh& mesh) const;

private:
  using Edge = std::pair<Index, Index>; ///< ascending
  using Polygon = std::vector<Index>;

  void divideEdges(Polygon& polygon) const;

  std::vector<Index> ids_;
  Eigen::SparseMatrix<double, Eigen::RowMajor, int> weights_; ///< #ids x #nodes
  /// The nodes on an edge, from its first end on.
  std::map<Edge, std::vector<Index>> onEdge_;
  /// The small faces of a cell's side, outward for that cell.
  std::map<std::pair<Index, int>, std::vector<Polygon>> covers_;
};

/// boundaryFaces() that also tells what hangs.
BoundaryFaces boundaryFaces(const Mesh& mesh, HangingNodes& hanging, Monitor& monitor);
}
