// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

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
}
