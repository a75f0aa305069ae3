// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Quality/Certificate.h"

#include <Eigen/Core>

namespace morph
{
/// The Jacobian determinant of a trilinear hexahedron, proved positive or found negative by
/// subdivision of its Bernstein form; the rounding of the coefficients and of every subdivision is
/// bounded. `x`: the eight corners in VTK's order, scaled by exactScale() (OrientationPredicate.h).
Certificate certifyTrilinear(const Eigen::Vector3d* x);

/// Bounds the rounding error of a Bernstein coefficient of a Jacobian determinant, and of what at
/// most 36 subdivisions make of it: each is a weighted mean of at most eight determinants of edges
/// not longer than the given ones.
double coefficientError(double longestR, double longestS, double longestT);
}
