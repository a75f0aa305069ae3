// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <array>

namespace morph
{
/// How a map's Jacobian is rated, from 1 for a rotation upwards: the regularised foldover-free
/// density of Garanzha et al. (ACM Trans. Graph. 40(4) (2021), arXiv 2102.03069),
///
///   phi(J) = (1 - theta) / 3 |J|^2 / chi^(2/3) + theta / 2 (1 + det^2) / chi,
///   chi = (det + sqrt(epsilon^2 + det^2)) / 2,
///
/// finite for inverted maps as long as epsilon > 0 and steep enough there to drive them out; for
/// epsilon towards 0 a barrier at det = 0. With stiffness t > 0 it is phi / (1 - t phi), a barrier
/// at phi = 1 / t that lowers the worst value instead of the mean (Garanzha et al., ACM Trans.
/// Graph. 43(1) (2024), arXiv 2201.12112).
struct FoldoverDensity
{
  double theta = 0.1;     ///< weight of the volume's change against that of the shape, in [0, 1]
  double epsilon = 1e-10; ///< regularisation, above 0
  double stiffness = 0;   ///< t, at least 0

  /// The density at J; infinite where stiffness times phi is 1 or more.
  double value(const Eigen::Matrix3d& J) const;
  /// phi itself, without the stiffness.
  double distortion(const Eigen::Matrix3d& J) const;
  /// d(density)/dJ as well.
  double gradient(const Eigen::Matrix3d& J, Eigen::Matrix3d& derivative) const;

  /// The second derivative with its negative eigenvalues left out, for displacements of a
  /// tetrahedron's corners 1 to 3: `block`[a][b] is 3 x 3, for the corners whose shape function
  /// gradients are columns a <= b of `g`. Closed form by the singular values (Smith, de Goes, Kim,
  /// ACM Trans. Graph. 38(1) (2019)), accurate to some 1e-7: it gives directions of search.
  void hessian(
    const Eigen::Matrix3d& J, const Eigen::Matrix3d& g, Eigen::Matrix3d (&block)[3][3]) const;
};

/// J = U diag(S) V^T with rotations U and V; the last of the descending singular values carries the
/// determinant's sign.
struct SignedSingularValues
{
  explicit SignedSingularValues(const Eigen::Matrix3d& J);
  Eigen::Matrix3d U, V;
  Eigen::Vector3d S;
};
}
