// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <array>
#include <vector>

namespace morph
{
/// Points p, q, r: the open half-space of all v with (p - v) . ((q - v) x (r - v)) > 0.
using HalfSpace = std::array<Eigen::RowVector3d, 3>;

/// Whether the half-spaces have a common point. First, a few projections in double search for one.
/// If they fail, a linear program in exact arithmetic (CGAL) decides, so false is proved. Returns
/// true where a coordinate is not finite.
bool haveCommonPoint(const std::vector<HalfSpace>& halfSpaces);
}
