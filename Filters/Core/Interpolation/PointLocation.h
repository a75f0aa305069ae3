// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Geometry/Delaunay.h"

#include <Eigen/Core>

#include <vector>

namespace morph
{
/// The tetrahedra of a tessellation that contain given nodes, and the nodes' barycentric
/// coordinates there.
///
/// Ties: a node on a face, an edge or a corner that several tetrahedra share goes to the one its
/// walk reaches first; all of them interpolate alike there. Walks run along a space-filling curve
/// over the nodes, in blocks of fixed length, so the choice depends on the places of nodes and
/// sites alone. Tetrahedra flat to 1e-13 contain nothing: their neighbors do.
///
/// A node on the hull, or beyond it by rounding (coordinates above -1e-9), takes the nearest
/// tetrahedron, the one in which its least coordinate is largest. The coordinates stay as they are
/// rather than being cut off at 0, so that linear fields are reproduced exactly; beyond -1e-9 that
/// is extrapolation, and counted.
struct PointLocation
{
  static constexpr double InsideTolerance = 1e-9; ///< of a barycentric coordinate
  using Coordinates = Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::RowMajor>;

  std::vector<int> tetrahedron; ///< #ids
  Coordinates barycentric; ///< #ids x 4, in the order of the tetrahedron's sites; rows sum to 1
  std::vector<Index> extrapolated; ///< ids of nodes outside the hull, ascending
};

/// `points`: all nodes; `ids`: those to find. Throws Error naming nodes that no tetrahedron near
/// them can carry to 1e-10 of the sites' size. Cost: a microsecond a node, in parallel, and a sort.
PointLocation locatePoints(
  const Delaunay& delaunay, const Points& points, const std::vector<Index>& ids, Monitor& monitor);
}
