// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <array>
#include <vector>

namespace morph
{
/// Three points p, q, r: the open half-space of the points v with (p - v) . ((q - v) x (r - v)) >
/// 0.
using HalfSpace = std::array<Eigen::RowVector3d, 3>;

/// Whether a point lies in all of these half-spaces. False only where that is proved: by a linear
/// program over exact numbers (CGAL), which is asked where a few projections in double have not
/// found such a point. True where a coordinate is not finite.
bool haveCommonPoint(const std::vector<HalfSpace>& halfSpaces);
}
