// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/Classification.h"
#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"

#include <vector>

namespace morph
{
struct FaceQuality
{
  /// #faces; NaN for a face that is neither triangle nor quadrilateral
  std::vector<double> scaledJacobian;
  /// #faces x 3: of the face at rest, carried along by its surface; its length means nothing
  Points normal;
  double minimum = 0;        ///< NaN if there is no face
  double mean = 0;           ///< NaN if there is no face
  std::vector<Index> folded; ///< faces at or below 0, ascending
};

/// Scaled Jacobian of each moved boundary face, signed by the normal of its surface: the least over
/// its corners of the sine between the two edges there, negative where the corner turns against the
/// normal; times 2/sqrt(3) for a triangle, so 1 is the ideal face. 0 where an edge has no length.
/// This is Knupp's measure (IJNME 48 (2000) 1165-1185) of a face in the tangent plane; without the
/// normal a face that is folded over looks like a good one.
///
/// The normal is that of the face at rest carried along by its surface: cof(F) n, with F the
/// gradient of the affine map nearest to the motion of the surface's nodes. For affine motions it
/// is exact, planar surfaces included; where a surface bends by 90 degrees against its mean motion
/// the sign means nothing. `rest`, `moved`: #nodes x 3. Cost: two passes over the faces.
FaceQuality faceQuality(const ConstPoints& rest, const ConstPoints& moved,
  const BoundaryFaces& faces, const Classification& geometry);
}
