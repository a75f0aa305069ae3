// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "FoldoverDensity.h"
#include "Objective.h"
#include "TargetShapes.h"
#include "Topology.h"

#include <vector>

namespace morph
{
/// The foldover-free energy of a mesh: the weighted mean of the density over the tetrahedra of all cells. Tetrahedra without a free
/// node are left out: nothing moves them.
class MeshEnergy : public SecondOrderObjective
{
public:
  /// `free`: ids of the nodes that move, ascending. Cost: passes over the cells; 100 bytes a cell.
  MeshEnergy(const Mesh& mesh, const std::vector<Index>& free);

  /// What the tetrahedra aim for, with their weights and theta; before anything below. Those of weight 0 are left out.
  void setTargets(const TargetShapes& targets);
  /// The regularisation and the stiffness; theta is that of the targets. With a regularisation below 1e-9 no step may end with an inverted tetrahedron.
  void setDensity(const FoldoverDensity& density) { this->density_ = density; }
  const FoldoverDensity& density() const { return this->density_; }

  struct State
  {
    double energy = 0;
    double leastDeterminant = 0; ///< relative to the targets; positive: no tetrahedron is inverted
    double mostDistortion = 0; ///< largest phi where the stiffness counts: not in tetrahedral cells
  };
  State evaluate(const Points& points, Monitor& monitor) const;

  const std::vector<Index>& free() const override { return this->free_; }
  Value value(const Points& points, Monitor& monitor) const override;
  void gradient(const Points& points, Points& result, Monitor& monitor) const override;
  void hessian(const Points& points, BlockMatrix& result, Monitor& monitor) const override;

private:
  using Corners = Eigen::Matrix<double, 3, 8>;

  Index cells() const { return static_cast<Index>(this->cornerStart_.size()) - 1; }
  int numberOfCorners(Index cell) const
  {
    return static_cast<int>(this->cornerStart_[cell + 1] - this->cornerStart_[cell]);
  }
  const std::int32_t* corners(Index cell) const
  {
    return this->corner_.data() + this->cornerStart_[cell];
  }
  Corners positions(Index cell, const Points& points) const;
  FoldoverDensity densityOf(const TargetShapes::Tetrahedron& tetrahedron) const;
  bool isMovable(const std::int32_t* corners, const TargetShapes::Tetrahedron& tetrahedron) const;
  void openMatrix(BlockMatrix& matrix) const;
  void cellHessian(Index cell, const Points& points, float* blocks) const;
  void gatherBlocks(const std::vector<float>& blocks, const std::vector<Index>& start,
    BlockMatrix& result, Monitor& monitor) const;

  std::vector<Index> free_;
  std::vector<std::int32_t> row_;                     ///< #nodes, place in `free`, or -1
  std::vector<Index> ofCell_;                         ///< volume cells by their ids
  std::vector<Index> cornerStart_;                    ///< #volume cells + 1
  std::vector<std::int32_t> corner_;                  ///< node ids
  Adjacency uses_;                                    ///< #free: places in `corner_`
  std::vector<Index> start_;                          ///< #volume cells + 1, into `tetrahedra_`
  std::vector<TargetShapes::Tetrahedron> tetrahedra_; ///< those with a free node
  FoldoverDensity density_;
};
}
