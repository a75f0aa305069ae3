// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Interpolation/RadialKernel.h"
#include "Support/Monitor.h"
#include "Support/Types.h"

#include <Eigen/Core>

#include <array>

namespace morph
{
/// Interpolates by one radial basis function a center and a linear polynomial:
///
///     s(x) = sum over centers c_j of a_j kernel(|x - c_j|) + p(x),
///     with sum a_j q(c_j) = 0 for every linear polynomial q
///
/// It is the identity on linear polynomials. Householder reflections project the polynomials out.
/// What remains is positive definite, so Cholesky factorises it: r^3 and r^2 log r are
/// conditionally positive definite of order 2, Wendland's kernel is positive definite.
///
/// Source: H. Wendland, "Scattered Data Approximation", Cambridge University Press 2005, chapters 8
/// and 9. D. Sieger, S. Menzel, M. Botsch, "High quality mesh morphing using triharmonic radial
/// basis functions", IMR 2012, solve the indefinite system instead.
class RadialInterpolant
{
public:
  /// What the values at the centers determine.
  struct Coefficients
  {
    Points ofKernels;                         ///< #centers x 3
    Eigen::Matrix<double, 4, 3> ofPolynomial; ///< 1, x, y, z
  };

  /// `centers`: #centers x 3, of about unit extent around the origin, at least four, not all in a
  /// plane. Returns false if rounding makes the system indefinite, as where centers nearly
  /// coincide. Cost: n^3 / 3 multiplications and additions; 8 n^2 bytes.
  bool prepare(const RadialKernel& kernel, const Points& centers, Monitor& monitor);

  const Points& centers() const { return this->centers_; }
  const RadialKernel& kernel() const { return this->kernel_; }

  /// `values`: #centers x 3. Cost: two passes over the factor.
  Coefficients solve(const Points& values) const;
  /// The adjoint of solve(): returns #centers x 3.
  Points solveTranspose(const Coefficients& gradient) const;

  /// Sets `values` to s at `targets`, #targets x 3.
  void evaluate(const Coefficients& coefficients, const Points& targets, Points& values,
    Monitor& monitor) const;
  /// The adjoint of evaluate(). `gradient`: #targets x 3.
  Coefficients evaluateTranspose(
    const Points& targets, const Points& gradient, Monitor& monitor) const;

private:
  using Reflector = Eigen::Matrix<double, Eigen::Dynamic, 4>;
  Eigen::MatrixXd reflect(const Points& values) const;
  Points reflectBack(Eigen::MatrixXd values) const;

  RadialKernel kernel_;
  Points centers_;
  Reflector reflectors_; ///< of the QR factorisation of (1, x, y, z) at the centers
  std::array<double, 4> scales_{};
  Eigen::Matrix4d triangle_; ///< R
  /// The reflected kernel matrix, lower triangle. Its last rows and columns hold the factor.
  Eigen::MatrixXd matrix_;
};
}
