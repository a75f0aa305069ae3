// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMorphing/BoundaryMotion.h"
#include "Support/Monitor.h"

#include <vector>

namespace morph
{
/// Gives the `free` nodes of one surface the displacement u + r: u the affine field nearest to the
/// motion of the `fixed` ones, and r their residuals smoothed over the surface's edges (Laplacian
/// smoothing to its limit): at each free corner r is the mean of its neighbors', weighted by 1 /
/// edge length at rest. So r nowhere exceeds the residuals around the surface, affine motions come
/// out exactly, and a curved surface keeps its shape. A mid-side or face node has the mean r of the
/// corners it lies between.
///
/// `faceIds`: the surface's faces; `fixed`, `free`: its nodes, ascending. Cost: one sparse solve
/// per surface.
void extendHarmonically(const BoundaryFaces& faces, const std::vector<Index>& faceIds,
  const std::vector<Index>& fixed, const std::vector<Index>& free, BoundaryMotion& motion,
  Monitor& monitor);
}
