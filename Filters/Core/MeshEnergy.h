// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BlockMatrix.h"
#include "FoldoverEnergy.h"
#include "Mesh.h"
#include "Monitor.h"
#include "TargetShapes.h"
#include "Topology.h"

#include <vector>

namespace morph
{
/// The foldover-free energy of a mesh: the weighted mean of the density over the tetrahedra of all cells, as a function of the positions
/// of the free nodes. Tetrahedra without a free node are left out: nothing moves them.
class MeshEnergy
{
public:
  struct State
  {
    double energy = 0;
    double leastDeterminant = 0; ///< relative to the targets; positive: no tetrahedron is inverted
    double mostDistortion = 0;   ///< largest phi where the stiffness counts: not in tetrahedral cells
  };

  /// `free`: ids of the nodes that move, ascending. Keeps references to `mesh` and `free`. Cost: passes over the cells.
  MeshEnergy(const Mesh& mesh, const std::vector<Index>& free);

  /// #tetrahedra that depend on a free node; see TargetShapes for their numbers.
  Index tetrahedra() const { return this->movable_; }
  /// Tetrahedra with all four nodes prescribed that are not positive there, by cell, ascending: no method can repair them.
  std::vector<Index> infeasibleCells(const TargetShapes& targets, const Points& points) const;

  /// `points`: #nodes x 3. The density's theta is that of the targets. Independent of the threads, as all of these are.
  State evaluate(
    const Points& points, const TargetShapes& targets, const FoldoverDensity& density, Monitor& monitor) const;
  /// `result`: #free x 3, d(energy)/d(position).
  void gradient(const Points& points, const TargetShapes& targets, const FoldoverDensity& density, Points& result,
    Monitor& monitor) const;
  /// The positive semi-definite part of the second derivatives, tetrahedron by tetrahedron; #free x #free blocks. The matrix is
  /// opened by the first call.
  void hessian(const Points& points, const TargetShapes& targets, const FoldoverDensity& density,
    BlockMatrix& result, Monitor& monitor) const;

private:
  bool isMovable(Index cell, const int* corner) const;
  void openMatrix(BlockMatrix& matrix) const;

  const Mesh& mesh_;
  const std::vector<Index>& free_;
  std::vector<std::int32_t> row_; ///< #nodes, place in `free`, or -1
  Adjacency around_;
  std::vector<Index> blockStart_; ///< #cells + 1, corners before: where a cell's gradient starts
  Index movable_ = 0;
};
}
