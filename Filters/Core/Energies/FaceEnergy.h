// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Energies/EnergyState.h"
#include "Optimization/Objective.h"
#include "Support/Lists.h"

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace morph
{
/// The inverse mean ratio of a plane map's Jacobian J, regularised and to a power p:
///
///   phi(J)^p,   phi(J) = |J|^2 / (2 chi(det J)),   chi(d) = (d + sqrt(d^2 + epsilon^2)) / 2.
///
/// It is 1 for a similarity and does not depend on the size of J. In two dimensions it also is the
/// condition number |J| |J^-1| / 2, as |J^-1| = |J| / det J. With epsilon > 0 it is finite for
/// inverted maps, and steep enough to remove inversions; with 0 it is a barrier at det J = 0. A
/// power above 1 pays more for the worst faces. Sources: J. M. Escobar et al., CMAME 192 (2003)
/// 2775-2787; P. M. Knupp, SIAM J. Sci. Comput. 23 (2001) 193-218.
struct FaceDensity
{
  using Hessian = Eigen::Matrix4d; ///< of the entries of J, by columns

  double epsilon = 0; ///< regularisation, at least 0
  int power = 1;      ///< p, at least 1

  /// Returns the density at J; infinite where it cannot be computed.
  double value(const Eigen::Matrix2d& J) const;
  /// Returns the density and computes d(density)/dJ, undefined where the density is infinite.
  double gradient(const Eigen::Matrix2d& J, Eigen::Matrix2d& derivative) const;
  /// Returns the second derivative of the density without negative eigenvalues of phi's. Closed
  /// form by the singular values (Smith, de Goes, Kim, ACM Trans. Graph. 38(1) (2019)).
  Hessian hessian(const Eigen::Matrix2d& J) const;

  /// d(det J)/dJ.
  static Eigen::Matrix2d cofactor(const Eigen::Matrix2d& J);
};

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
