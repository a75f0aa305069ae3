// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMorphing/BoundaryProjection.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// Which surfaces smoothSurfaceMeshes() smooths.
enum class SmoothedSurfaces : std::uint8_t
{
  All,
  Folded ///< those with a face in foldedFaces()
};

/// The result of smoothSurfaceMeshes().
struct SurfaceMeshSmoothing
{
  std::vector<Index> smoothed; ///< numbers of surfaces with a better mesh, ascending
  std::vector<Index> kept;     ///< numbers of surfaces whose start is better, ascending
  Index steps = 0;             ///< of Newton's method
};

/// Smooths the meshes of surfaces that follow, as section 3.1 of Staten et al. (IMR 2011) does.
/// Call it after smoothSurfaces(), whose result is the start. It skips surfaces that move affinely.
/// On the others, the corners that they moved (state OnSurface) lower the sum, over the corners of
/// the faces, of
///
///   w (|J|^2 / (2 det J))^8.
///
/// J is the corner's map from its undeformed shape in its own plane, w as in SurfaceSmoothing.h.
/// The base is the inverse mean ratio, which in two dimensions is the condition number, too. The
/// power makes the worst faces count most.
///
/// 1. Where a corner is inverted, the regularised measure of FaceEnergy.h untangles, in up to 40
///    stages of 10 Newton steps. Six stages without gain end it.
/// 2. Newton's method lowers the sum, in up to 20 rounds. Nodes move in their tangent planes, then
///    to the `target`, if it holds the surface. Without one they keep to the surface's own shape at
///    the start (PhongSurface.h). Valid faces stay valid.
/// 3. Nodes around faces that fell below the surface's minimum of the start return. Then the better
///    of result and start is kept: fewer folded faces, else the higher minimum scaled Jacobian,
///    else the higher mean.
///
/// Affine images of the undeformed surface stay; in a plane they are stationary. Nodes that are not
/// on their target stay. Mid-side and face nodes follow their corners. The result does not depend
/// on threads. Cost: per Newton step about a microsecond a corner.
SurfaceMeshSmoothing smoothSurfaceMeshes(const BoundaryFaces& faces, const Classification& geometry,
  const ProjectionTarget* target, SmoothedSurfaces which, BoundaryMotion& motion, Monitor& monitor);
}
