// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Geometry/Delaunay.h"

#include <Eigen/Core>

#include <vector>

namespace morph
{
/// Locates nodes in a tessellation: their tetrahedra and barycentric coordinates.
///
/// Ties: a node on a shared face, edge or corner belongs to the tetrahedron that its walk reaches
/// first. All candidates interpolate equally there. Walks follow a space-filling curve over the
/// nodes in blocks of fixed length. So the choice depends only on the positions of nodes and sites.
/// Tetrahedra flat to 1e-13 or to rounding contain nothing; their neighbors contain their nodes.
///
/// A node on the hull, or beyond it by rounding (coordinates above -1e-9), takes the tetrahedron in
/// which its minimum coordinate is largest. Coordinates are not clipped at 0, so linear fields are
/// reproduced exactly. Beyond -1e-9 this is extrapolation, and counted.
struct PointLocation
{
  static constexpr double InsideTolerance = 1e-9; ///< of a barycentric coordinate
  using Coordinates = Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::RowMajor>;

  std::vector<int> tetrahedron; ///< #ids
  Coordinates barycentric; ///< #ids x 4, in the order of the tetrahedron's sites; rows sum to 1
  std::vector<Index> extrapolated; ///< ids of nodes outside the hull, ascending
};

/// `points`: all nodes, #nodes x 3; `ids`: the nodes to find. Throws Error naming nodes that no
/// nearby tetrahedron reproduces to 1e-10 of the sites' size. Cost: a microsecond a node, in
/// parallel, and a sort.
PointLocation locatePoints(
  const Delaunay& delaunay, const Points& points, const std::vector<Index>& ids, Monitor& monitor);
}
