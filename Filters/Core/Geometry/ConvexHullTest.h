// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

namespace morph
{
/// Whether `x` lies in the convex hull of `points` (#points x 3) or on it: whether no plane through
/// x has all of them strictly on one side. In terms of the unit vectors from x to the points: their
/// hull's point nearest to the origin is at most 1e-7 from it. That depends on directions alone, so
/// it is the same after rotations and scaling, but for rounding. Wolfe's algorithm (Math.
/// Programming 11 (1976) 128-149): usually fewer than ten passes over the points.
bool insideConvexHull(const Eigen::RowVector3d& x, const ConstPoints& points);
}
