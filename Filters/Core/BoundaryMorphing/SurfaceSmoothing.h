// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMorphing/BoundaryProjection.h"

namespace morph
{
/// What smoothSurfaces() did.
struct SurfaceSmoothing
{
  Index poor = 0;           ///< faces it set out from
  std::vector<Index> moved; ///< node ids, ascending
};

/// Smoothing of surfaces by local quality: corners that their surface moved (state OnSurface),
/// within two faces of one whose scaled Jacobian (see faceQuality()) is below 0.2 and below half of
/// what it was at rest, move along the surface. One after the other, for up to 20 sweeps, each goes
/// to lower the sum, over the corners of the faces around it, of
///
///   A |J|^2 / (2 chi(det J)),   chi(d) = (d + sqrt(d^2 + delta^2)) / 2,
///
/// J the corner's map from its rest shape in the tangent plane, A its area at rest, det J signed by
/// the surface's normal, so that a folded face counts as inverted; delta is 0 once all are positive
/// (mean ratio against the shape at rest, regularised as in Escobar et al., CMAME 192 (2003)
/// 2775-2787). Newton steps, halved until the sum is lower. A node stays in its tangent plane or,
/// with a `target`, on that. Affine images of the surface at rest are stationary. Mid-side and face
/// nodes go along with their corners. To be called after morphSurfaces(), and after
/// projectSurfaces() where there is a target. Cost: a few passes over the faces, and some 20
/// evaluations a sweep for nodes near poor faces.
SurfaceSmoothing smoothSurfaces(const BoundaryFaces& faces, const Classification& geometry,
  const ProjectionTarget* target, BoundaryMotion& motion, Monitor& monitor);
}
