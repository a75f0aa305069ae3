// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Quality/Certificate.h"

#include <Eigen/Core>

namespace morph
{
/// Proves the Jacobian determinant of a trilinear hexahedron positive, or finds it negative. The
/// proof subdivides the Bernstein form and bounds the rounding of all coefficients and
/// subdivisions. `x`: the eight corners in VTK's order, scaled by exactScale()
/// (BernsteinDomain.h).
Certificate certifyTrilinear(const Eigen::Vector3d* x);

/// Bounds the rounding error of a Bernstein coefficient of a Jacobian determinant after at most 36
/// subdivisions. A coefficient is a weighted mean of at most eight determinants of edges; the
/// arguments bound the edges' lengths.
double coefficientError(double longestR, double longestS, double longestT);
}
