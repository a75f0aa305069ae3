// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMorphing/BoundaryMotion.h"
#include "Support/Monitor.h"

#include <vector>

namespace morph
{
/// Moves the `free` nodes of one surface by u + r. u is the affine field that fits the motion of
/// the `fixed` nodes, and r is the discrete harmonic extension of their residuals. At each free
/// corner r is the mean of its neighbors', weighted by 1 / undeformed edge length. So r never
/// exceeds the residuals around the surface, affine motions are exact, and a curved surface keeps
/// its shape. A mid-side or face node has the mean r of its corners.
///
/// `faceIds`: the surface's faces; `fixed`, `free`: its nodes, ascending. Cost: one sparse solve a
/// surface.
void extendHarmonically(const BoundaryFaces& faces, const std::vector<Index>& faceIds,
  const std::vector<Index>& fixed, const std::vector<Index>& free, BoundaryMotion& motion,
  Monitor& monitor);
}
