// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMorphing/BoundaryMotion.h"
#include "Geometry/AffineFit.h"

#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace morph
{
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
  const Eigen::RowVector3d& center() const { return this->center_; }

  /// The nodes' principal directions, to move others. `places`: #places x 3.
  PrincipalDirections directions(const Points& places) const;

  /// Returns the affine displacement field that fits the displacements, zero if all of them are.
  AffineFit affineFit(const PrincipalDirections& directions) const;

  /// The field of the rigid motion x' = c' + (x - c) R^T, without reflection, that fits the
  /// displacements by least squares. If the nodes lie on a line, it is the fit with the smallest
  /// angle; where they nearly do, that angle counts by what `directions` leave. Source: Kabsch,
  /// Acta Cryst. A32 (1976) 922-923.
  AffineFit rigidFit(const PrincipalDirections& directions) const;

private:
  double count_ = 0;
  Eigen::RowVector3d center_ = Eigen::RowVector3d::Zero(); ///< mean position
  Eigen::RowVector3d mean_ = Eigen::RowVector3d::Zero();   ///< mean displacement
  Eigen::Matrix3d spread_ = Eigen::Matrix3d::Zero();       ///< of (x - c)^T (x - c)
  Eigen::Matrix3d stretch_ = Eigen::Matrix3d::Zero();      ///< of (x - c)^T (d - mean)
};

/// The motion of one set of nodes, or of several, each by its weight.
class MotionAround
{
public:
  bool empty() const { return this->parts_.empty(); }
  /// Adds a set that tells a `share`, in [0, 1], of what the sets before it leave. The last set
  /// tells the rest, too.
  void add(const MotionSums& sums, const PrincipalDirections& directions, double share);
  /// What the sets leave: 0 if the last needs no other.
  double left() const { return this->left_; }

  /// A weighted sum of displacement fields; zero without one.
  struct Mixture
  {
    std::vector<std::pair<double, AffineFit>> parts;

    Eigen::RowVector3d displacement(const Eigen::RowVector3d& x) const
    {
      Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
      for (const auto& [weight, fit] : this->parts)
      {
        sum += weight * fit.displacement(x);
      }
      return sum;
    }
  };
  Mixture affineFit() const { return this->mixture(&MotionSums::affineFit); }
  Mixture rigidFit() const { return this->mixture(&MotionSums::rigidFit); }

private:
  struct Part
  {
    MotionSums sums;
    PrincipalDirections directions;
    double weight;
  };
  Mixture mixture(AffineFit (MotionSums::*fit)(const PrincipalDirections& directions) const) const;

  std::vector<Part> parts_;
  double left_ = 1;
};

/// Moves `nodes` with the nodes of `around` by the fit that `how` selects; by zero if `around` is
/// empty.
void extrapolate(const MotionAround& around, const std::vector<Index>& nodes, UnattachedMotion how,
  BoundaryMotion& motion);

/// The known displacements of a boundary, summed at most once by surface and by body, when they are
/// asked for. Curves and surfaces fit affine or rigid fields to these sums.
class KnownMotion
{
public:
  /// Keeps references to both; `motion` must not change while the object is in use. Cost: a look at
  /// the surfaces' nodes.
  KnownMotion(const Classification& geometry, const BoundaryMotion& motion);

  /// Returns the motion of the first set whose affine span (line, plane, space) contains the curve,
  /// or of the last nonempty one. The sets are the known nodes of the curve, of its adjacent
  /// surfaces, of its body: none where a body has no known node. An affine motion of the set is
  /// then known on the curve. Where a set is nearly flat and the curve leaves it, the set tells a
  /// share, and the next ones the rest (PrincipalDirections). Cost: the curve's nodes; once for
  /// each set of adjacent surfaces, the nodes of all but the largest.
  MotionAround around(const GeometryCurve& curve);
  /// The same for other nodes on a body. Cost: `nodes`.
  MotionAround around(Index body, const std::vector<Index>& nodes);

  /// Returns the number of known nodes summed so far, a measure of the cost.
  Index summed() const { return this->summed_; }

private:
  MotionSums sumOf(const std::vector<Index>& ids);
  const MotionSums& ofSurface(Index surface);
  /// Sums by body, unless that is done.
  void sumBodies();
  const MotionSums& besides(const GeometryCurve& curve);
  void add(const MotionSums& sums, const Points& places, MotionAround& around) const;
  void addBody(Index body, const Points& places, MotionAround& around);

  const BoundaryMotion& motion_;
  /// maximum distance of a node from an affine span that contains it
  double tolerance_ = 0;
  std::vector<std::vector<Index>> ofSurface_;      ///< #surfaces: the known nodes
  std::vector<std::optional<MotionSums>> surface_; ///< #surfaces
  /// one more than #bodies; the first has the nodes of no body; empty where not summed
  std::vector<MotionSums> body_;
  std::map<std::vector<Index>, MotionSums> besides_; ///< by the adjacent surfaces of a curve
  Index summed_ = 0;
};
}
