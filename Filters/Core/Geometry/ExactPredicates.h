// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace morph
{
/// Returns the sign of det [b - a, c - a, d - a], exactly for the coordinates as given (CGAL). A
/// tetrahedron in VTK's order has 1, a flat one 0, an inverted one -1. The coordinates must be
/// finite. Cost: 0.1 microseconds, or 2 for a nearly flat tetrahedron.
int orientationSign(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
  const Eigen::Vector3d& d);

/// Returns the pairs of boxes that have a point in common, ascending, the lower number first. One
/// of each pair at least is chosen, and `isWanted` is true of it. `isChosen`: #boxes, nonzero for
/// a chosen box. Source: CGAL, box_intersection_d. Cost: n log^3 n and the pairs.
std::vector<std::array<Index, 2>> overlappingBoxes(const std::vector<Eigen::AlignedBox3d>& boxes,
  const std::vector<std::uint8_t>& isChosen, const std::function<bool(Index, Index)>& isWanted);

/// Points p, q, r: the open half-space of all v with (p - v) . ((q - v) x (r - v)) > 0.
using HalfSpace = std::array<Eigen::RowVector3d, 3>;

/// Whether the half-spaces have a common point. First, a few projections in double search for one.
/// If they fail, a linear program in exact arithmetic (CGAL) decides, so false is proved. Returns
/// true where a coordinate is not finite.
bool haveCommonPoint(const std::vector<HalfSpace>& halfSpaces);
}
