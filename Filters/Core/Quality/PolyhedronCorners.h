// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"

#include <Eigen/Core>

#include <vector>

namespace morph
{
/// A corner of a polyhedron, and the other ends of its three edges: their determinant is positive
/// where the cell is valid and convex.
struct PolyhedronCorner
{
  Index node, last, next, other;
};

/// The position of a node; `sign`: of the z coordinates, -1 for the mirror image.
inline Eigen::Vector3d nodeAt(const ConstPoints& points, Index node, double sign)
{
  return { points(node, 0), points(node, 1), sign * points(node, 2) };
}

/// The length, correct also if its square underflows.
double lengthOf(const Eigen::Vector3d& v);

/// The determinant of the directions; NaN where one has no length.
double determinantOfDirections(
  const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);

/// Finds the corners where three edges of a cell meet, as the undeformed mesh has them. A node in a
/// flat face or on a straight edge, or at which the cell is concave, is none; see
/// PolyhedronMeasure.
class PolyhedronCorners
{
public:
  /// Returns the corners, which are valid until the next call. `sign`: see nodeAt(). Cost: a sort
  /// of the nodes of the faces.
  const std::vector<PolyhedronCorner>& find(const Mesh& mesh, Index cell, double sign);

private:
  struct InFace
  {
    Index node, last, next;
  };
  std::vector<InFace> inFaces_;
  std::vector<PolyhedronCorner> found_;
};
}
