// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/Classification.h"
#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// Returns the vector area of each face, #faces x 3: its unit normal by the right-hand rule times
/// its area. `points`: #nodes x 3. Cost: one pass over the faces.
Points faceAreas(const ConstPoints& points, const BoundaryFaces& faces);

/// Returns unit normals at `nodes` (from faces.nodes, ascending), #nodes x 3. A normal is the
/// direction of the summed `areas` (#faces x 3) of the node's faces. If any of them have a nonzero
/// entry in `isChosen` (#faces), only these count. A mid-side or face node takes the faces with all
/// the corners it is between. Throws Error naming nodes whose areas cancel or are all zero. Cost:
/// one pass over the faces.
Points nodeNormals(const Points& areas, const BoundaryFaces& faces,
  const std::vector<std::uint8_t>& isChosen, const std::vector<Index>& nodes);

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

/// Returns the boundary faces, ascending, that a motion folds: their faceQuality() is 0 or less,
/// and the fold is visible. It is visible at the face itself if a quadrilateral's corners turn
/// different ways. Or it is visible at the rim of a patch of other such faces. There, at half or
/// more of the edges inside the surface, the faces on both sides oppose each other. The rim
/// distinguishes folds from strong bends, where the sign of faceQuality() is meaningless. `rest`,
/// `moved`: #nodes x 3. Cost: that of faceQuality(), and a pass over the edges.
std::vector<Index> foldedFaces(const ConstPoints& rest, const ConstPoints& moved,
  const BoundaryFaces& faces, const Classification& geometry);

/// Returns the folded faces with fixed nodes only. `isFixed`: #nodes, nonzero where a node is
/// fixed.
std::vector<Index> foldedFaces(const ConstPoints& rest, const ConstPoints& moved,
  const BoundaryFaces& faces, const Classification& geometry, const std::vector<char>& isFixed);
}
