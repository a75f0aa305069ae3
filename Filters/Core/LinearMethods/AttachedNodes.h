// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/NodePartition.h"
#include "Support/Adjacency.h"

#include <Eigen/SparseCholesky>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace morph
{
/// Nodes of shells, beams and links that no volume cell uses. They are linked along cells of
/// dimension 1 and 2 to anchors: nodes of volume cells, and prescribed nodes. An anchor a moves by
/// u_a, and the volume cells around it turn by R_a: the rotation next to the affine fit to the
/// displacements of their nodes. A node at x that hangs on anchors moves by
///
///     u(x) = sum over a of h_a(x) (u_a + (R_a - I) (x - a)).
///
/// The weights h_a solve the graph Laplace equation on the links, each of the weight 1 / length, so
/// that they are 1 at their anchor, and 0 at the others. They sum to 1: a rigid motion of the
/// volume is one of the nodes, and what hangs at one anchor is rigid. Along a beam between two
/// anchors they are linear. A stretch of the volume is not passed on, but that between anchors is.
class AttachedNodes
{
public:
  struct Link
  {
    Index a, b;
    double length;
  };

  /// What a process has of a mesh that is on several.
  struct Piece
  {
    std::function<Index(Index id)> nodeOf; ///< the node of an id, or -1
    std::function<bool(Index node)> owns;  ///< each node is owned by one process
    /// adds numbers up over the processes
    std::function<void(double* values, std::size_t count)> sum;
  };

  /// The links of a mesh, by its own nodes. `skip`: nonzero for cells without links; may be empty.
  static std::vector<Link> linksOf(const Mesh& mesh, const std::vector<std::uint8_t>& skip = {});
  /// The nodes of links that are anchors, ascending.
  static std::vector<Index> anchorsOf(
    const Mesh& mesh, const std::vector<Link>& links, const std::vector<Index>& prescribed);

  AttachedNodes() = default;
  /// Of a mesh that this process has whole. `rest` has to outlive it.
  AttachedNodes(const Mesh& rest, const NodePartition& partition);
  /// Of a mesh in pieces. `links`, `anchors`: of all processes, by ids. `rest`: the piece, with all
  /// volume cells around the nodes that it owns.
  AttachedNodes(const Mesh& rest, std::vector<Link> links, std::vector<Index> anchors, Piece piece);

  /// The nodes that hang on anchors, and those that hang on none, by ids, ascending.
  ///@{
  const std::vector<Index>& nodes() const { return this->ids_; }
  const std::vector<Index>& loose() const { return this->loose_; }
  ///@}

  /// Places the nodes. `moved`: #nodes of the mesh x 3, where all others have moved. Nodes stay to
  /// the bit if nothing moves. Collective. Cost: a fit for each anchor, and a sparse solve.
  void apply(Points& moved) const;
  /// The adjoint of apply() about the undeformed mesh: adds the derivatives with respect to the
  /// nodes to those of all others, and sets them to zero. `gradient`: #nodes of the mesh x 3; of
  /// nodes that the process owns. Derivatives at others are to be added to their owners'.
  void applyTranspose(Points& gradient) const;

private:
  using Rows = Eigen::MatrixXd; ///< 12 columns: a translation, and a 3 x 3 matrix by rows
  using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

  void prepare(std::vector<Link> links, std::vector<Index> anchors);
  void findRings();
  Points ringOf(Index anchor, const Points& points) const;

  const Mesh* rest_ = nullptr;
  Piece piece_;
  std::vector<Index> ids_, loose_, anchors_;
  std::vector<Index> nodeOfAnchor_; ///< #anchors; -1 for those that another process owns
  Matrix coupling_;                 ///< #nodes x #anchors
  std::vector<int> reference_;      ///< #nodes, an anchor of its part
  std::shared_ptr<Eigen::SimplicialLDLT<Matrix>> factor_;
  Adjacency rings_; ///< of each such anchor: the nodes of the volume cells around it, with it
  Eigen::RowVector3d origin_ = Eigen::RowVector3d::Zero();
};
}
