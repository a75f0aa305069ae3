// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Quality/Certificate.h"
#include "Quality/PolyhedronCorners.h"

#include <Eigen/Core>

#include <vector>

namespace morph
{
/// The centres that OpenFOAM computes for a polyhedron, and the pyramids between them.
///
/// The area vector of a face is the sum of its triangles, between the edges and the mean of the
/// nodes. Its centre is the mean of the triangles' centres, weighted by the size of their areas.
/// The cell's centre is that of the pyramids between the faces and the mean of the face centres.
/// Source: OpenFOAM, primitiveMeshFaceCentresAndAreas.C and primitiveMeshCellCentresAndVols.C.
struct PolyhedronCenters
{
  std::vector<Eigen::Vector3d> areas, centers; ///< of the faces, in their order
  Eigen::Vector3d cell;                        ///< the cell's centre
  std::vector<double> triangles;               ///< the doubled areas of the triangles, face by face
  std::vector<double> shares; ///< of each face's centre in the cell's; their sum is 1

  /// `sign`: of the z coordinates, -1 to compute the mirror image. Cost: a pass over the faces.
  void compute(const Mesh& mesh, Index cell, const ConstPoints& points, double sign);
};

/// The scaled Jacobian of polyhedra: the least of these determinants of directions of length 1.
///
/// - At each corner where three edges of the cell meet: the three edges, as of a hexahedron. A node
///   in a flat face or on a straight edge, or at which the cell is concave, is no corner. It is one
///   if the determinant in the undeformed mesh, Mesh::points, is 0.3 or more. A positive one is
///   enough if the angles between the edges add up to 300 degrees or less.
/// - For each edge of a face: the edge, the line from its middle to the face's centre, and the line
///   from the cell's centre to the face's.
///
/// It is 1 for a box. The second kind has the sign of the tetrahedron of the edge and both centres,
/// so a positive value means that every tetrahedron is positive. Since a face's pyramid is the sum
/// of its tetrahedra, OpenFOAM's tests of volumes and face pyramids then pass.
class PolyhedronMeasure
{
public:
  /// `sign`: see PolyhedronCenters. NaN where a coordinate is not finite, or without faces. Sets
  /// `isCollapsed` where one of the directions has no length; the value is then 0. Cost: about 3
  /// microseconds for six faces.
  double scaledJacobian(
    const Mesh& mesh, Index cell, const ConstPoints& points, double sign, bool& isCollapsed);

  /// OpenFOAM's test of face pyramids: Certified if the volume between each face and the cell's
  /// centre is positive, Inverted if one is not. Undecided where it is 0 but for rounding.
  Certificate certify(const Mesh& mesh, Index cell, const ConstPoints& points, double sign);

private:
  double leastCorner(const Mesh& mesh, Index cell, const ConstPoints& points, double sign);

  PolyhedronCenters centers_;
  PolyhedronCorners corners_;
};
}
