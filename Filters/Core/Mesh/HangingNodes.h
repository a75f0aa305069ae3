// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/NodePartition.h"
#include "Mesh/Topology.h"
#include "Support/Monitor.h"

#include <Eigen/SparseCore>

#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace morph
{
/// Faces that are divided on one side alone, as where a cell meets cells of half its size (2:1
/// refinement, octree meshes). Faces of other cells then lie in one, have its corners, and fill it.
/// All of them are inside the mesh. The nodes of the small faces that are no nodes of the large one
/// hang. They are tied to its nodes by the shape functions at their place, or to those of an edge
/// if they lie on it. So no gap opens. A tie to a node that hangs, too, is one to what that is tied
/// to.
///
/// Cells are linear or quadratic: faces of 3, 4, 6, 8 and 9 nodes. Polyhedra may have such faces,
/// as collapsed hexahedra do, or the small faces themselves.
class HangingNodes
{
public:
  /// Finds them among the faces that one cell alone has; see facesOfOneCell(). Cost: a pass over
  /// the faces, some microseconds each.
  void find(const Mesh& mesh, const BoundaryFaces& faces, Monitor& monitor);
  /// Whether find() can find some where the cells `isOf`, #cells, have the large faces. The mesh
  /// may be a part of one, with all cells around the nodes of these cells. Cost: as find().
  static bool mayBeAmong(const Mesh& mesh, const BoundaryFaces& faces,
    const std::vector<std::uint8_t>& isOf, Monitor& monitor);

  /// Whether no face is divided on one side alone.
  bool empty() const
  {
    return this->covers_.empty() && this->onEdge_.empty() && this->ids_.empty();
  }
  /// The nodes that hang, ascending. There may be none where a face is only cut.
  const std::vector<Index>& nodes() const { return this->ids_; }
  bool hangs(Index node) const;
  /// Whether a face that one cell alone has is inside the mesh: divided, or a part of one.
  bool isInside(Index cell, int side) const { return this->inside_.count({ cell, side }) > 0; }
  /// Returns the partition for a method on conforming(): nodes that hang on prescribed nodes alone
  /// are prescribed, too. `partition`: of the mesh, where the nodes that hang are free.
  NodePartition extend(NodePartition partition) const;
  /// Gives large faces the nodes that hang on their edges as corners, as the small ones beside them
  /// have these, so that neighbors share edges.
  void divideEdges(BoundaryFaces& faces) const;
  /// Returns those of `nodes`, ascending, that nodes are tied to.
  std::vector<Index> tiedTo(const std::vector<Index>& nodes) const;
  /// Returns the ids of nodes that do not hang.
  std::vector<Index> without(const std::vector<Index>& ids) const;
  /// The same with ties to what the followers among their nodes follow. `weightsOf`: as
  /// HigherOrderNodes has them.
  HangingNodes following(const std::function<std::map<Index, double>(Index node)>& weightsOf) const;

  /// Fills the rows of `displacement`, #nodes x 3, of nodes that hang from those of the others.
  void apply(Points& displacement) const;
  /// The adjoint of apply(): adds their rows to those of the others, and sets them to zero.
  void applyTranspose(Points& gradient) const;
  /// Places them in a moved mesh. `rest`, `moved`: #nodes x 3.
  void place(const Points& rest, Points& moved) const;

  /// Returns the mesh with polyhedra for the cells at divided faces and edges, so that neighbors
  /// have equal faces. Ids of nodes and cells stay. The polyhedra have the corners of the cells
  /// alone. `mesh`: that of find(), with these or other points.
  Mesh conforming(const Mesh& mesh) const;

  /// For the parts of a distributed mesh.
  ///@{
  /// Returns the nodes, ascending, that a part of the mesh with the nodes `known` and the cells
  /// `cells`, ascending, has to know: those on its faces and edges, and what they are tied to.
  std::vector<Index> reach(const std::vector<Index>& known, const std::vector<Index>& cells) const;
  /// Returns what is known of a part. `nodeOf`, `cellOf`: the numbers there, -1 for none. `nodes`:
  /// that the part has.
  HangingNodes renumbered(
    const std::vector<Index>& nodeOf, const std::vector<Index>& cellOf, Index nodes) const;
  ///@}

private:
  using Edge = std::pair<Index, Index>; ///< ascending
  using Polygon = std::vector<Index>;
  using Weights = Eigen::SparseMatrix<double, Eigen::RowMajor, int>;

  void divideEdges(Polygon& polygon) const;
  void take(const std::map<Index, std::map<Index, double>>& ties, Index nodes);
  std::map<Index, std::map<Index, double>> ties() const;

  std::vector<Index> ids_;
  Weights weights_; ///< #ids x #nodes
  /// The corners on an edge, from its first end on.
  std::map<Edge, std::vector<Index>> onEdge_;
  /// The corners of the small faces of a cell's side, outward for that cell.
  std::map<std::pair<Index, int>, std::vector<Polygon>> covers_;
  std::set<std::pair<Index, int>> inside_; ///< cells and sides
};

/// The faces that one cell alone has: the boundary and, where faces are divided on one side alone,
/// these and their parts. Cost: see boundaryFaces().
BoundaryFaces facesOfOneCell(const Mesh& mesh, Monitor& monitor);
/// boundaryFaces() that also tells what hangs.
BoundaryFaces boundaryFaces(const Mesh& mesh, HangingNodes& hanging, Monitor& monitor);
/// boundaryFaces() where it is known what hangs. `faces`: facesOfOneCell().
BoundaryFaces boundaryFaces(
  const Mesh& mesh, const BoundaryFaces& faces, const HangingNodes& hanging);
/// partitionNodes() where all nodes that hang and are not prescribed are free.
NodePartition partitionNodes(
  const Mesh& mesh, const HangingNodes& hanging, std::vector<Index> prescribed);
}
