// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMorphing/BoundaryMotion.h"
#include "Geometry/AffineFit.h"

#include <vector>

namespace morph
{
/// The points that lie in the flat through some nodes: their common point, line, plane or all
/// space.
class AffineSpan
{
public:
  /// `centre`: the nodes' mean position; `spread`: their second moments about it.
  AffineSpan(const Eigen::RowVector3d& centre, const Eigen::Matrix3d& spread);
  /// How far `x` is from it.
  double distance(const Eigen::RowVector3d& x) const;

private:
  Eigen::RowVector3d centre_;
  Eigen::Matrix3d normal_; ///< projects onto what is perpendicular
};

/// What fits need to know of a set of nodes with displacements: sums that can be added, so that
/// nobody has to walk through a set again that is made of others.
class MotionSums
{
public:
  MotionSums() = default;
  MotionSums(const BoundaryMotion& motion, const std::vector<Index>& ids);
  /// Adds a set that has no node in common with this one. Cost: constant.
  void add(const MotionSums& other);

  bool empty() const { return this->count_ == 0; }
  AffineSpan flat() const { return AffineSpan(this->centre_, this->spread_); }

  /// The affine displacement field nearest to the nodes' displacements. It is zero where those are.
  AffineFit affineFit() const;

  /// The rigid motion x' = c' + (x - c) R^T nearest to theirs in the sense of least squares
  /// (Kabsch, Acta Cryst. A32 (1976) 922-923), without reflection; where the nodes lie on a line,
  /// of all turns that fit the one by the smallest angle.
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

/// The affine displacement field nearest to the displacements of `ids`. It is zero where those are.
AffineFit affineFit(const BoundaryMotion& motion, const std::vector<Index>& ids);

/// Gives `nodes` the displacement by which `how` makes them follow the nodes of `sums`; zero where
/// that is empty.
void extrapolate(const MotionSums& sums, const std::vector<Index>& nodes, UnattachedMotion how,
  BoundaryMotion& motion);
}
