// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Interpolation/InterpolationSites.h"
#include "Interpolation/RadialInterpolant.h"
#include "Morpher/Morpher.h"

#include <atomic>
#include <memory>

namespace morph
{
/// Radial basis functions with a linear polynomial, through the displacements of all prescribed
/// nodes. The method is meshless: it ignores cells. It is exact for affine motions.
///
/// Up to 4,000 distinct sites (see InterpolationSites), each is the center of a kernel: a dense,
/// positive definite system (RadialInterpolant). The default kernel r^3 makes the field triharmonic
/// and the method invariant to rigid motion and scale. Source: D. Sieger, S. Menzel, M. Botsch,
/// "RBF morphing techniques for simulation-based design optimization", Engineering with Computers
/// 30 (2014) 161-174.
///
/// Of more sites, 2,000 in farthest-point order are centers. Compact kernels of a few scales
/// correct the residual that these leave at the others (CompactCorrection), so the result is exact
/// at all sites. No matrix of sites by nodes is stored: memory is linear in nodes, and nearly in
/// sites. Source: L. Kedward, C.
/// B. Allen, T. C. S. Rendall, Journal of Computational Physics 345 (2017) 732-751.
///
/// Sites nearer than 1e-5 of the extent to others are always corrected by compact kernels: as
/// centers they would make the system indefinite to rounding.
///
/// prepare(): a Cholesky factorisation, #centers^3 / 3 multiplications and additions, and a k-d
/// tree search. It keeps 8 #centers^2 bytes, and 12 bytes a node in a compact kernel. evaluate()
/// and applyTranspose(): one kernel a center and free node, see kernelSums(). Options take effect
/// at the next prepare().
class RadialBasis : public LinearMorpher
{
public:
  static constexpr Index FewestCenters = 4;
  static constexpr Index MostCenters = 4000;   ///< of the dense system
  static constexpr Index CentersOfMany = 2000; ///< where there are more sites

  /// Default Triharmonic.
  void setKernel(RadialKernel::Kind kind) { this->kind_ = kind; }
  RadialKernel::Kind kernel() const { return this->kind_; }

  /// Sets the radius of WendlandC2, relative to the sites' extent: twice the largest distance from
  /// their mean. Finite and positive, default 1. Throws Error otherwise.
  void setSupportRadius(double radius);
  double supportRadius() const { return this->supportRadius_; }

  /// Sets the number of centers: 0, the default, stands for all sites up to 4,000, and for 2,000 of
  /// more. Otherwise 4 to 4,000, or all sites where there are fewer. Fewer centers take less time;
  /// the other sites' residuals are corrected nearby. Throws Error otherwise.
  void setNumberOfCenters(Index count);
  Index numberOfCenters() const { return this->numberOfCenters_; }

  /// Returns the centers that the last prepare() chose, and the sites it left for correction.
  ///@{
  Index centers() const { return this->interpolant_.centers().rows(); }
  Index correctedSites() const { return this->sites_.size() - this->centers(); }
  ///@}
  /// Returns for each center a prescribed node there, in farthest-point order.
  std::vector<Index> centerNodes() const;
  /// Returns the largest residual that the centers left at the other sites in the last evaluate(),
  /// before the correction, in the mesh's unit. Calls from several threads at once leave that of
  /// one.
  double largestResidual() const { return this->largestResidual_; }

  std::unique_ptr<Morpher> copyWithoutCells() const override
  {
    auto copy = std::make_unique<RadialBasis>();
    copy->kind_ = this->kind_;
    copy->supportRadius_ = this->supportRadius_;
    copy->numberOfCenters_ = this->numberOfCenters_;
    return copy;
  }

protected:
  /// Throws Error of kind Singular for sites in one plane, or where rounding makes the system
  /// indefinite.
  void doPrepare(const Mesh& rest, Monitor& monitor) override;
  bool hasPrepareOptionsOf(const Morpher& other) const override
  {
    const auto& basis = static_cast<const RadialBasis&>(other);
    return this->kind_ == basis.kind_ && this->supportRadius_ == basis.supportRadius_ &&
           this->numberOfCenters_ == basis.numberOfCenters_;
  }
  EvaluateReport displace(const Points& prescribed, Points& free, Monitor& monitor) const override;
  EvaluateReport displaceTranspose(
    const Points& free, Points& prescribed, Monitor& monitor) const override;

private:
  /// `residual`: the largest of the centers, in the mesh's unit.
  EvaluateReport report(double residual) const;
  void requireSpace() const;
  Points scaled(const Points& positions) const;

  RadialKernel::Kind kind_ = RadialKernel::Kind::Triharmonic;
  double supportRadius_ = 1;
  Index numberOfCenters_ = 0;

  InterpolationSites sites_;
  Eigen::RowVector3d origin_;
  double extent_ = 1;
  std::vector<Index> order_; ///< all sites, in farthest-point order: the centers first
  Points otherPlaces_;       ///< scaled, of the sites that are no centers
  Points freePlaces_;        ///< scaled, #free x 3
  RadialInterpolant interpolant_;
  CompactCorrection correction_;
  mutable std::atomic<double> largestResidual_{ 0 };
};
}
