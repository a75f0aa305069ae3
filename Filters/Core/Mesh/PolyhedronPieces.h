// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/NodePartition.h"
#include "Support/Monitor.h"

#include <Eigen/SparseCore>

#include <vector>

namespace morph
{
/// A mesh whose polyhedra are cut into tetrahedra and pyramids, for methods that know these alone.
///
/// Each polyhedron gets a node at its center, and each face a piece up to there: a tetrahedron on a
/// triangle, a pyramid on a quadrilateral. A face of more nodes, or a quadrilateral with a corner
/// that is flat or turned inward, gets a node at its center and a tetrahedron on each edge. Both
/// cells at a face cut it alike. A quadrilateral of a hexahedron, wedge or pyramid stays whole, so
/// that the mesh is conforming. So does a polyhedron that is a tetrahedron or hexahedron with
/// whole faces and clearly positive corners.
///
/// Node ids stay; the centers of faces follow, then those of cells. Cell ids stay, too: that of a
/// polyhedron is now its first piece, and its other pieces come after all cells.
class PolyhedronPieces
{
public:
  /// `mesh`: valid, its polyhedra oriented (Polyhedra.h). `cutsAll`: cuts tetrahedra and hexahedra,
  /// too, for tests. Cost: see faceTable(), and a pass.
  PolyhedronPieces(const Mesh& mesh, Monitor& monitor, bool cutsAll = false);

  /// The pieces and the other cells, with the centers at their first places.
  const Mesh& mesh() const { return this->pieces_; }
  /// Returns `points`, #nodes x 3, and after them the centers: the mean of a face's nodes, and the
  /// mean of a cell's faces, weighted by their undeformed areas. Affine motions map them, too.
  Points extend(const ConstPoints& points) const;
  /// Adds the gradient of the centers to that of the nodes that they are means of: the adjoint of
  /// extend(). `all`: with the centers; returns #nodes x 3.
  Points extendTranspose(const ConstPoints& all) const;
  /// The groups of all nodes. Centers of faces whose nodes are all prescribed are prescribed, too,
  /// and come last; the other centers are free. Nodes that no cell here has are left out.
  /// `partition`: of the mesh without centers.
  NodePartition extend(const NodePartition& partition) const;

  /// Returns `values`, one a cell, for each piece: that of the cell it is cut from.
  std::vector<double> extend(const std::vector<double>& values) const;

  /// For the parts of a distributed mesh: the cell that a piece is cut from, the number of centers
  /// of faces, which come before those of cells, and the weights of the nodes in all centers.
  ///@{
  Index cellOf(Index piece) const;
  Index faceCenters() const { return this->faceCenters_; }
  const Eigen::SparseMatrix<double, Eigen::RowMajor, int>& means() const { return this->means_; }
  ///@}

private:
  Mesh pieces_;
  std::vector<Index> cellOfOther_; ///< the cell of each piece beyond the mesh's cells
  Index nodes_ = 0;                ///< without centers
  Index faceCenters_ = 0;
  Eigen::SparseMatrix<double, Eigen::RowMajor, int> means_; ///< #centers x #nodes
};
}
