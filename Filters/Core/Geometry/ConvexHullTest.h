// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

namespace morph
{
/// Whether `x` lies in or on the convex hull of `points` (#points x 3). The test uses unit vectors
/// from x to the points: it is true where the origin is within 1e-7 of their hull. So it is
/// invariant to rotation and scaling, up to rounding. Source: Wolfe's algorithm (Math. Programming
/// 11 (1976) 128-149). Cost: usually fewer than ten passes over the points.
bool insideConvexHull(const Eigen::RowVector3d& x, const ConstPoints& points);
}
