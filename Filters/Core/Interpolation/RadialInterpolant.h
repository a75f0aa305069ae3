// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Interpolation/WeightMatrix.h"
#include "Support/Monitor.h"
#include "Support/Types.h"

#include <Eigen/Core>

#include <array>
#include <memory>
#include <vector>

namespace morph
{
/// A function of the distance r between two positions.
struct RadialKernel
{
  enum class Kind
  {
    Triharmonic, ///< r^3
    ThinPlate,   ///< r^2 log r
    WendlandC2   ///< (1 - q)^4 (4 q + 1) for q = r / radius below 1, else 0
  };

  Kind kind = Kind::Triharmonic;
  double radius = 1; ///< of WendlandC2, positive

  double operator()(double squaredDistance) const;
};

/// Sets row i of `sums` to the sum over j of kernel(|targets_i - sources_j|) strengths_j.
/// `targets`: #targets x 3; `sources`, `strengths`: #sources x 3; `sums`: becomes #targets x 3. The
/// kernel is symmetric, so exchanging targets and sources gives the product with the transpose.
/// Each sum adds the sources in their order: it depends neither on threads nor on other targets. No
/// matrix is stored.
///
/// Cost: one kernel a pair of target and source. For r^3 that is 17 operations, a square root among
/// them, on four or two pairs at once; memory traffic is negligible. The square root, which
/// processors do not pipeline fully, sets the limit.
void kernelSums(const RadialKernel& kernel, const Points& targets, const Points& sources,
  const Points& strengths, Points& sums, Monitor& monitor);

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

/// Interpolates residuals by compact kernels of ever smaller radius. Sites are in farthest-point
/// order, so the first n of them cover all evenly. A level has the sites up to some number, and
/// Wendland's C2 kernel, whose radius is 2.5 times their distance. It interpolates what the levels
/// before have left, at all its sites. The last level has all sites: the sum is exact there.
///
/// Source: M. S. Floater, A. Iske, "Multistep scattered data interpolation using compactly
/// supported radial basis functions", Journal of Computational and Applied Mathematics 73 (1996)
/// 65-78; H. Wendland, "Piecewise polynomial, positive definite and compactly supported radial
/// functions of minimal degree", Advances in Computational Mathematics 4 (1995) 389-396.
class CompactCorrection
{
public:
  CompactCorrection();
  ~CompactCorrection();
  CompactCorrection(CompactCorrection&&) noexcept;
  CompactCorrection& operator=(CompactCorrection&&) noexcept;

  /// `sites`, #sites x 3, and `distances`, of each: in farthest-point order (PointOrders.h). The
  /// first `exact` have no residual. `targets`: #targets x 3. Cost and memory: some 20 neighbors of
  /// a site and target a level.
  void prepare(const Points& sites, const std::vector<double>& distances, Index exact,
    const Points& targets, Monitor& monitor);

  /// Returns the levels; 0 without residuals.
  Index numberOfLevels() const;
  /// Adds the interpolant to `values`, #targets x 3. `residuals`: #sites x 3; of the first `exact`
  /// it takes 0 for granted. Cost: some 50 products with the kernels at the sites a level.
  void addTo(Points& values, Points residuals, Monitor& monitor) const;
  /// The adjoint of addTo(): returns #sites x 3, of the first `exact` 0. `gradient`: #targets x 3.
  Points transposed(const Points& gradient, Monitor& monitor) const;

private:
  struct Level;
  Index sites_ = 0, exact_ = 0;
  std::vector<std::unique_ptr<Level>> levels_;
};
}
