// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMorphing/BoundaryMotion.h"
#include "Geometry/AffineFit.h"

#include <vector>

namespace morph
{
/// The affine span of some nodes: their common point, line, plane or all of space.
class AffineSpan
{
public:
  /// `centre`: the nodes' mean position; `spread`: their second moments about it.
  AffineSpan(const Eigen::RowVector3d& centre, const Eigen::Matrix3d& spread);
  /// Returns the distance of `x` from the span.
  double distance(const Eigen::RowVector3d& x) const;

private:
  Eigen::RowVector3d centre_;
  Eigen::Matrix3d normal_; ///< projects onto the orthogonal complement
};

/// Sums over nodes with displacements, from which fits follow. Sums of disjoint sets can be added
/// without visiting their nodes again.
class MotionSums
{
public:
  MotionSums() = default;
  MotionSums(const BoundaryMotion& motion, const std::vector<Index>& ids);
  /// Adds a set without common nodes. Cost: constant.
  void add(const MotionSums& other);

  bool empty() const { return this->count_ == 0; }
  AffineSpan flat() const { return AffineSpan(this->centre_, this->spread_); }

  /// Returns the affine displacement field that fits the displacements, zero if all of them are.
  AffineFit affineFit() const;

  /// The rigid motion x' = c' + (x - c) R^T, without reflection, that fits the displacements by
  /// least squares. If the nodes lie on a line, it is the fit with the smallest angle. Source:
  /// Kabsch, Acta Cryst. A32 (1976) 922-923.
  class RigidFit
  {
  public:
    Eigen::RowVector3d displacement(const Eigen::RowVector3d& x) const;

  private:
    friend class MotionSums;
    Eigen::RowVector3d centre_, shift_;
    Eigen::Matrix3d turn_; ///< R - I
  };
  RigidFit rigidFit() const;

private:
  Index count_ = 0;
  Eigen::RowVector3d centre_ = Eigen::RowVector3d::Zero(); ///< mean position
  Eigen::RowVector3d mean_ = Eigen::RowVector3d::Zero();   ///< mean displacement
  Eigen::Matrix3d spread_ = Eigen::Matrix3d::Zero();       ///< of (x - c)^T (x - c)
  Eigen::Matrix3d stretch_ = Eigen::Matrix3d::Zero();      ///< of (x - c)^T (d - mean)
};

/// Returns the affine displacement field that fits the displacements of `ids`, zero if all are.
AffineFit affineFit(const BoundaryMotion& motion, const std::vector<Index>& ids);

/// Moves `nodes` with the nodes of `sums` by the fit that `how` selects; by zero if `sums` is
/// empty.
void extrapolate(const MotionSums& sums, const std::vector<Index>& nodes, UnattachedMotion how,
  BoundaryMotion& motion);
}
