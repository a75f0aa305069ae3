// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "AffineFit.h"
#include "BoundaryMotion.h"

#include <vector>

namespace morph
{
/// The points that lie in the flat through some nodes: their common point, line, plane or all space.
class Flat
{
public:
  Flat(const Points& rest, const std::vector<Index>& ids);
  /// How far `x` is from it.
  double distance(const Eigen::RowVector3d& x) const;

private:
  Eigen::RowVector3d centre_;
  Eigen::Matrix3d normal_; ///< projects onto what is perpendicular
};

/// The first of `sets` (node ids with known displacements) whose flat holds all of `nodes`, to 1e-9 of the model's
/// size: an affine motion of that set is known at those nodes. The last set that is not empty if none does; an empty
/// list if all are.
const std::vector<Index>& spanningSet(
  const Points& rest, const std::vector<Index>& nodes, const std::vector<std::vector<Index>>& sets);

/// The affine displacement field nearest to the displacements of `ids`. It is zero where those are.
AffineFit affineFit(const BoundaryMotion& motion, const std::vector<Index>& ids);

/// Gives `nodes` the displacement by which `how` makes them follow the nodes `ids`; zero where that is empty. The
/// rigid motion is that of least squares (Kabsch, Acta Cryst. A32 (1976) 922-923), without reflection; where `ids`
/// lie on a line, of all turns that fit the one by the smallest angle.
void follow(const std::vector<Index>& ids, const std::vector<Index>& nodes, Unattached how,
  BoundaryMotion& motion);
}
