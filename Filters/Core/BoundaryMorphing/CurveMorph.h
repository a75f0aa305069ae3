// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/Classification.h"
#include "BoundaryMorphing/BoundaryMotion.h"
#include "Support/Monitor.h"

namespace morph
{
/// Moves the nodes of all curves that are not given: each keeps its parameter on the moved curve.
/// Vertices, and nodes given on curves and surfaces, keep their positions.
///
/// A node at parameter t between the known nodes (or vertices) a and b, t_a <= t <= t_b, moves by
///   u(x) + (1 - s) (U_a - u(x_a)) + s (U_b - u(x_b)),   s = (t - t_a) / (t_b - t_a),
/// where u is the affine field that fits the motion around the curve.
///
/// On a straight curve by arc length u cancels, and U is linear in t. On a curved one u maps its
/// shape, so affine motions are exact. u fits the first set whose affine span contains the curve.
/// The sets are the known nodes of the curve, of its adjacent surfaces, of its body. If none does,
/// u has minimum norm; a body without known nodes stays.
///
/// A closed curve without a known node follows the nodes of the same sets by `unattached`. Without
/// motion the result is exactly zero. It does not depend on the order of curves.
///
/// Returns the number of known nodes that the fits summed. Cost: linear in the boundary for any
/// number of curves. The sums of a surface and of a body are computed once; see KnownMotion.
Index morphCurves(const Classification& geometry, UnattachedMotion unattached,
  BoundaryMotion& motion, Monitor& monitor);
}
