// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Energies/EnergyState.h"
#include "Energies/FaceDensity.h"
#include "Optimization/Objective.h"
#include "Support/Adjacency.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// A corner of a face, with its target shape.
struct FaceCorner
{
  Index node[3];           ///< the corner, the next node of the face, the one before
  Eigen::Matrix2d inverse; ///< of the target's two edges, as columns
  double weight;
};

/// The energy of a surface mesh: the weighted sum of a density over the corners of its faces. A
/// corner counts by the map J from its target to its edges in the corner's plane, which is fixed
/// between calls of setPlanes(). Nodes move in their tangent planes alone. On one process.
class FaceEnergy : public SecondOrderObjective
{
public:
  using Plane = Eigen::Matrix<double, 3, 2>; ///< two orthonormal tangents
  /// Of a plane, right-handed with its unit normal.
  static Plane tangents(const Eigen::RowVector3d& normal);

  /// `free`: ids of the nodes that move; `nodes`: their number in the mesh. Corners without a free
  /// node are constant: leave them out.
  FaceEnergy(std::vector<FaceCorner> corners, const std::vector<Index>& free, Index nodes);

  /// Sets each corner's plane, by its unit normal (#corners x 3), and each free node's tangent
  /// plane, by its unit normal (#free x 3). Right-handed with its normal, a corner has a positive
  /// determinant.
  void setPlanes(const Points& cornerNormals, const Points& nodeNormals);
  void setDensity(const FaceDensity& density) { this->density_ = density; }

  const std::vector<FaceCorner>& corners() const { return this->corners_; }

  EnergyState evaluate(const Points& points, Monitor& monitor) const;

  const std::vector<Index>& free() const override { return this->free_; }
  /// Without a regularisation no step may end with an inverted corner.
  Value value(const Points& points, Monitor& monitor) const override;
  void gradient(const Points& points, Points& result, Monitor& monitor) const override;
  void hessian(const Points& points, BlockCsr3f& result, Monitor& monitor) const override;

private:
  Eigen::Matrix2d jacobian(Index corner, const Points& points) const;
  void openMatrix(BlockCsr3f& matrix) const;
  /// Makes the row's diagonal block invertible: along the normal nothing moves, or costs anything.
  void addAlongNormal(Index row, BlockCsr3f& matrix) const;
  std::int32_t rowAt(Index place) const
  {
    return this->row_[this->corners_[place / 3].node[place % 3]];
  }

  PatternId pattern_; ///< of the second derivatives
  std::vector<FaceCorner> corners_;
  std::vector<Index> free_;
  std::vector<std::int32_t> row_; ///< #nodes, -1 for a node that is not free
  Adjacency uses_;                ///< #free: places, three a corner
  std::vector<Plane> planes_;     ///< #corners
  Points normals_;                ///< #free x 3
  FaceDensity density_;
  mutable Points parts_; ///< of the gradient, kept between calls
};
}
