// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <array>

namespace morph
{
/// The regularised foldover-free density of a map's Jacobian J, from 1 for a rotation upwards
/// (Garanzha et al., ACM Trans. Graph. 40(4) (2021), arXiv 2102.03069):
///
///   phi(J) = (1 - theta) / 3 |J|^2 / chi^(2/3) + theta / 2 (1 + det^2) / chi,
///   chi = (det + sqrt(epsilon^2 + det^2)) / 2.
///
/// It is finite for inverted maps while epsilon > 0, and steep enough there to remove inversions.
/// For epsilon towards 0 it becomes a barrier at det = 0.
struct FoldoverDensity
{
  double theta = 0.1;     ///< weight of the change of volume against that of shape, in [0, 1]
  double epsilon = 1e-10; ///< regularisation, above 0

  /// Returns the density at J; infinite where it cannot be computed.
  double value(const Eigen::Matrix3d& J) const;
  /// Returns the density and computes d(density)/dJ.
  double gradient(const Eigen::Matrix3d& J, Eigen::Matrix3d& derivative) const;

  /// Computes the second derivative without its negative eigenvalues, for displacements of a
  /// tetrahedron's corners 1 to 3. `g`: its columns are the shape function gradients of these
  /// corners. `block`[a][b]: 3 x 3, for corners a <= b. Closed form by the singular values (Smith,
  /// de Goes, Kim, ACM Trans. Graph. 38(1) (2019)). Accurate to about 1e-7, enough for search
  /// directions.
  void hessian(
    const Eigen::Matrix3d& J, const Eigen::Matrix3d& g, Eigen::Matrix3d (&block)[3][3]) const;
};

/// The decomposition J = U diag(S) V^T with rotations U and V. Singular values descend; the last
/// has the sign of the determinant.
struct SignedSingularValues
{
  explicit SignedSingularValues(const Eigen::Matrix3d& J);
  Eigen::Matrix3d U, V;
  Eigen::Vector3d S;
};
}
