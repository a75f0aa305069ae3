// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/Classification.h"
#include "BoundaryMorphing/BoundaryMotion.h"
#include "Support/Monitor.h"

namespace morph
{
/// Moves the nodes of all curves that are not given: they keep their parameter on the moved curve.
/// Vertices, and nodes given on curves and surfaces, stay as they are.
///
/// A node at parameter t between the known nodes (or vertices) a and b of its curve, at t_a <= t <=
/// t_b, moves by
///   u(x) + (1 - s) (U_a - u(x_a)) + s (U_b - u(x_b)),   s = (t - t_a) / (t_b - t_a),
/// with u the affine field nearest to the motion around the curve. On a straight curve by arc
/// length u drops out, and U is linear in t; on a curved one u carries the bulge along, so that
/// affine motions come out exactly. u is fitted to the smallest of these sets whose flat (line,
/// plane, space) holds the curve: the curve's own known nodes, those on the surfaces beside it, on
/// its body, on all bodies. Where none does, u is of minimum norm.
///
/// A closed curve without any known node follows the nodes of the same sets by `unattached`. Where
/// nothing moves the result is zero, exactly. Independent of the curves' order.
///
/// Returns how many known nodes the fits summed up: it grows linearly with the boundary, however
/// many curves there are, as does the rest of the cost. The sums of a surface, body or of all are
/// made once; see KnownMotion.
Index morphCurves(const Classification& geometry, UnattachedMotion unattached,
  BoundaryMotion& motion, Monitor& monitor);
}
