// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

#include <array>
#include <vector>

namespace morph
{
using TargetTriangle = std::array<Index, 3>; ///< ids of points

/// Returns the triangles that are part of a surface, without repeated and flat ones, whose height
/// is within `rounding`. A flat one may join a long edge of one side to the shorter edges of the
/// other side: the triangle at its long edge is divided, so that the surface stays connected. In
/// the order given, the parts of divided ones last. `points`: #points x 3; the corners of a
/// triangle are three points. Cost: a sort, and log n for each flat triangle.
std::vector<TargetTriangle> cleanTriangles(
  const Points& points, const std::vector<TargetTriangle>& triangles, double rounding);
}
