// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LinearMethods/LogBarrierWeights.h"
#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"
#include "Solvers/AssembleRows.h"

#include <array>
#include <vector>

namespace morph
{
/// Columns of [W_I W_B]: the free nodes in the order of the rows, then the prescribed nodes.
struct WeightColumns
{
  WeightColumns(Index nodes, const std::vector<Index>& rows, const std::vector<Index>& prescribed);

  std::vector<int> ofNode;  ///< #nodes, -1 for a node in neither
  std::vector<Index> nodes; ///< node of each column
};

/// One row of LBWARP's weights: a node's neighbors and their weights. Use one object a thread.
class NodeWeights
{
public:
  /// The origin of the weights.
  enum class Kind
  {
    OneRing, ///< log-barrier weights among the nodes that share a volume cell with the node
    TwoRing, ///< log-barrier weights among these nodes and their neighbors
    /// affine weights of minimum norm of the one ring: exact for affine maps, some negative
    Affine,
    Stiffness, ///< FEMWARP's row
    None       ///< no weights: only OneRing was allowed, or every cell around has zero volume
  };

  /// The arguments must outlive this object. `around`: nodeToCells(mesh).
  NodeWeights(const Mesh& mesh, const Adjacency& around, const WeightColumns& columns);

  /// Computes the weights of `node`. With `relax` the kinds are tried in order, otherwise only the
  /// first.
  Kind compute(Index node, bool relax);

  /// Ascending, without the node's own column.
  const std::vector<int>& columns() const { return this->columns_; }
  /// One per column, sum 1.
  const std::vector<double>& weights() const { return this->weights_; }
  /// Returns the Newton steps of the last compute().
  int iterations() const { return this->iterations_; }

private:
  void gather(Index node);
  void widen();
  void takeOffsets(Index node);
  void takeTangents(Index node);
  bool logBarrier();
  bool leastNormAffine();
  bool stiffness(Index node);

  const Mesh* mesh_;
  const Adjacency* around_;
  const WeightColumns* numbers_;

  LogBarrierWeights solver_;
  std::vector<int> columns_;
  std::vector<double> weights_;
  std::vector<std::array<double, 3>> offsets_;
  int iterations_ = 0;
  SparseRow met_; ///< the node's own column and those gathered
};
}
