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
  /// #faces x 3: normal of the undeformed face, mapped by its surface's motion; any length
  Points normal;
  double minimum = 0;        ///< NaN if there is no face
  double mean = 0;           ///< NaN if there is no face
  std::vector<Index> folded; ///< faces at or below 0, ascending
};

/// Computes the scaled Jacobian of each moved boundary face, signed by the normal of its surface.
/// It is the minimum over the corners of the sine between the edges, negative where the corner
/// turns against the normal. Triangles get the factor 2/sqrt(3), so 1 is the ideal face; an edge
/// without length gives 0. This is Knupp's measure (IJNME 48 (2000) 1165-1185) in the tangent
/// plane. Without the normal, a folded face would look good.
///
/// The normal is cof(F) n: n of the undeformed face, F the gradient of the affine map that fits the
/// motion of the surface's nodes. It is exact for affine motions, including planar surfaces. Where
/// a surface bends by 90 degrees against its mean motion, the sign is meaningless. `rest`, `moved`:
/// #nodes x 3. Cost: two passes over the faces.
FaceQuality faceQuality(const ConstPoints& rest, const ConstPoints& moved,
  const BoundaryFaces& faces, const Classification& geometry);
}
