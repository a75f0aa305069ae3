// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Topology.h"
#include "Support/Lists.h"
#include "Support/Types.h"

#include <array>
#include <vector>

namespace morph
{
/// The shape of a triangulated surface, curved by the normals of its nodes: Phong tessellation
/// (Boubekeur, Alexa, ACM Trans. Graph. 27(5) (2008) 141) with the factor 1/2, which reproduces
/// curvature to second order. It goes through all nodes. A surface whose nodes are in a plane, to
/// 1e-9 of its extent, is that plane, which has no end.
class PhongSurface
{
public:
  using Row = Eigen::RowVector3d;

  /// `points`: #nodes x 3; `faceIds`: the surface's faces, at least one. Polygons are cut into
  /// triangles. Normals are the mean of a node's triangles, weighted by area. Cost: a few passes
  /// over the faces.
  PhongSurface(
    const ConstPoints& points, const BoundaryFaces& faces, const std::vector<Index>& faceIds);

  bool isPlane() const { return this->isPlane_; }
  /// The plane's unit normal, on the side of most of the faces' areas.
  const Row& planeNormal() const { return this->planeNormal_; }

  /// Returns a triangle at the node, at which a search may begin.
  Index triangleAt(Index node) const;
  /// Returns the surface's point near `x`, by a walk over neighbors from `triangle`, which becomes
  /// that of the point. It is the nearest one unless the surface bends back. Safe in several
  /// threads.
  Row closest(const Row& x, Index& triangle) const;

private:
  struct Place;
  bool fitPlane();
  Place nearestIn(Index triangle, const Row& x) const;

  std::vector<Index> nodes_;                    ///< ids, ascending
  Points points_, normals_;                     ///< #nodes_ x 3
  std::vector<std::array<Index, 3>> triangles_; ///< places in nodes_
  Adjacency around_;                            ///< #nodes_: triangles
  bool isPlane_ = false;
  Row center_ = Row::Zero(), planeNormal_ = Row::Zero();
};
}
