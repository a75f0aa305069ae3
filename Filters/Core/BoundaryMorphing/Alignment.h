// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Geometry/TriangleTree.h"
#include "Support/Monitor.h"

#include <Eigen/Geometry>

#include <vector>

namespace morph
{
/// Returns the rotation and shift that lays the triangles of `surface` on those of `onto`; both
/// have some. `landmarks`: points of the surface, of which some hundred are taken, evenly from all.
/// Iterative closest points, each by Umeyama's least squares (IEEE Trans. PAMI 13 (1991) 376-380),
/// run from six starts: the current place, equal centers, and the four rotations that turn
/// principal axes into each other. The start that ends with the least mean distance is taken; of
/// nearly equal ones the first, which turns it less. A symmetric surface may so be turned about its
/// symmetry. Cost: some 70,000 searches at most.
Eigen::Isometry3d alignment(
  const TriangleTree& surface, const Points& landmarks, const TriangleTree& onto, Monitor& monitor);
}
