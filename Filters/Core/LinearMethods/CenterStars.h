// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/NodePartition.h"
#include "Morpher/Morpher.h"
#include "Support/Lists.h"
#include "Support/Monitor.h"

#include <vector>

namespace morph
{
/// Centers of polyhedra and of their faces that are eliminated cell by cell, before equations are
/// assembled (static condensation). A star is such a center with the cells around it. It enters the
/// equations like one cell of its other nodes, and the center is a weighted mean of these.
///
/// No two of these centers share a cell. A star has at most 16 nodes beside its center. It couples
/// at most 8 pairs of them more than its center did, so that the matrix stays sparse.
class CenterStars
{
public:
  static constexpr int MostNodes = 16;

  CenterStars() = default;
  /// Chooses among the `free` nodes, ascending, from `firstCenter` on. `around`: nodeToCells(mesh).
  /// Cost: a pass over the cells around these nodes.
  CenterStars(
    const Mesh& mesh, const std::vector<Index>& free, Index firstCenter, const Adjacency& around);

  Index size() const { return static_cast<Index>(this->centers_.size()); }
  /// Returns the `free` nodes that are no such centers.
  std::vector<Index> others(const std::vector<Index>& free) const;
  /// The centers, ascending.
  const std::vector<Index>& centers() const { return this->centers_; }
  Index center(Index star) const { return this->centers_[star]; }
  /// The other nodes of each star, ascending.
  const Adjacency& nodes() const { return this->nodes_; }
  /// The stars of each node, ascending; empty where there are no stars.
  const Adjacency& ofNode() const { return this->ofNode_; }
  /// The star that each cell belongs to, or -1; empty where there are no stars.
  const std::vector<int>& ofCell() const { return this->ofCell_; }

  /// The weights of a star's nodes in its center, to be set where the equations are assembled.
  double* weights(Index star) { return this->weights_.data() + this->nodes_.offsets[star]; }

  /// Keeps what the methods below need, and frees what those above give. `nodes`: #nodes.
  void assembled(Index nodes, const NodePartition& partition);
  /// Sets the centers' rows of `free`, #free rows, from those of their nodes in `free` and in
  /// `prescribed`, #prescribed rows.
  ///@{
  void recover(const Points& prescribed, Points& free, Monitor& monitor) const;
  void recover(const FourFields& prescribed, FourFields& free, Monitor& monitor) const;
  ///@}
  /// Adds the gradient of the centers to that of their nodes: the adjoint of recover().
  void recoverTranspose(Points& free, Points& prescribed) const;

private:
  std::vector<Index> centers_;
  Adjacency nodes_;
  std::vector<double> weights_; ///< of nodes_.values
  std::vector<int> ofCell_;
  Adjacency ofNode_;
  std::vector<int> rowOfCenter_; ///< of `free`
  /// Of nodes_.values: the row i of `free`, or -1 - i for the row i of `prescribed`.
  std::vector<int> places_;
};
}
