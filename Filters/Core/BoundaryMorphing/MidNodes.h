// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/NodesBetween.h"
#include "BoundaryMorphing/BoundaryProjection.h"

namespace morph
{
/// Moves mid-side and face nodes that their surface moved (state OnSurface) with their corners: by
/// meanBetween() of the shifts of these since `before` (#nodes x 3, moved positions), and onto the
/// `target`, if not null. `normals`: of surfaceNodeNormals(), read with a target alone.
void carryMidNodes(const BoundaryFaces& faces, const Classification& geometry,
  const ProjectionTarget* target, const Points& normals, const Points& before,
  BoundaryMotion& motion);
}
