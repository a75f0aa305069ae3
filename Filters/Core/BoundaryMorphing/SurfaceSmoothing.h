// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMorphing/BoundaryProjection.h"

namespace morph
{
/// Smooths surfaces where faces are poor: their scaled Jacobian (see faceQuality()) is below 0.2
/// and has lost half of its undeformed size. Corners that their surface moved (state OnSurface),
/// within two faces of a poor one, move along the surface. For up to 20 sweeps, each in turn lowers
/// the sum, over the corners of its faces, of
///
///   w |J|^2 / (2 chi(det J)),   chi(d) = (d + sqrt(d^2 + delta^2)) / 2.
///
/// J is the corner's map from its undeformed shape in the tangent plane. w is the area of its
/// undeformed triangle over 3 in triangles and over 2 in quadrilaterals, whose corners cover them
/// three times and twice. So affine images of surfaces with both are stationary, too.
/// det J has the sign of the surface's normal, so a folded face counts as inverted. delta is 0 once
/// all are positive. This is the mean ratio against the undeformed shape, regularised as in Escobar
/// et al., CMAME 192 (2003) 2775-2787.
///
/// Newton steps are halved until the sum decreases. A node stays in its tangent plane or on the
/// `target`, if not null. Affine images of the undeformed surface are stationary. Mid-side and face
/// nodes follow their corners. Call it after morphSurfaces(), or after projectSurfaces() if there
/// is a target. Cost: a few passes over the faces, and some 20 evaluations a sweep for nodes near
/// poor faces.
void smoothSurfaces(const BoundaryFaces& faces, const Classification& geometry,
  const ProjectionTarget* target, BoundaryMotion& motion, Monitor& monitor);
}
