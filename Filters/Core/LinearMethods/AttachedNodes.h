// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/NodePartition.h"
#include "Support/Communicator.h"
#include "Support/Lists.h"

#include <Eigen/SparseCholesky>

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
  AttachedNodes() = default;
  /// `rest`: on several processes this one's part, with all volume cells around the nodes that
  /// count here. Holds it and `processes` by reference. Collective. Cost: each process gets all
  /// links.
  AttachedNodes(const Mesh& rest, const NodePartition& partition,
    const Communicator& processes = Communicator::alone());

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

  struct Link
  {
    Index a, b;
    double length;
  };
  std::vector<Link> linksHere(const Mesh& rest) const;
  std::vector<Link> linksOfAll(std::vector<Link> links) const;
  void prepare(std::vector<Link> links, std::vector<Index> anchors);
  void findNodes();
  bool countsHere(Index node) const;
  void findRings();
  Points ringOf(Index anchor, const Points& points) const;

  const Mesh* rest_ = nullptr;
  const Communicator* processes_ = &Communicator::alone();
  std::vector<Index> ids_, loose_, anchors_;
  std::vector<Index> nodeOf_;       ///< #nodes, here; -1 for those that only others have
  std::vector<Index> nodeOfAnchor_; ///< #anchors; -1 for those that count on another process
  std::vector<Index> elsewhere_;    ///< nodes here that count on another process
  Matrix coupling_;                 ///< #nodes x #anchors
  std::vector<int> reference_;      ///< #nodes, an anchor of its part
  std::shared_ptr<Eigen::SimplicialLDLT<Matrix>> factor_;
  Adjacency rings_; ///< of each such anchor: the nodes of the volume cells around it, with it
  Eigen::RowVector3d origin_ = Eigen::RowVector3d::Zero();
};
}
