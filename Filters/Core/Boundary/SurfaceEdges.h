// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"

#include <array>
#include <vector>

namespace morph
{
/// The edges of boundary faces, between corners, and how the faces meet there.
struct SurfaceEdges
{
  std::vector<std::array<Index, 2>> nodes; ///< #edges, lower node id first, ascending
  Adjacency faces;                         ///< #edges: the faces that use the edge, ascending
  Adjacency ofFace; ///< #faces: its edges, the k-th from its corner k to the next
  /// #edges, degrees in [0, 180]: the angle between the normals of the edge's two faces, 0 where
  /// they continue each other, whichever way each is wound. NaN where not exactly two faces meet. A
  /// face without area continues its neighbor at its longest edge, so the faces on both sides of it
  /// meet as if it were not there.
  std::vector<double> angle;
  /// Faces without area that were looked at for a neighbor's normal: at most 5 times their number,
  /// a measure of the cost.
  Index visits = 0;

  Index count() const { return static_cast<Index>(this->nodes.size()); }
  /// The edge between two nodes, or -1.
  Index find(Index a, Index b) const;
};

/// `points`: #nodes x 3, positions of all nodes. The normal of a face is that of its vector area,
/// so warped quadrilaterals have one. Cost: a sort of the faces' edges.
SurfaceEdges surfaceEdges(const ConstPoints& points, const BoundaryFaces& faces);

/// Half the cross product of the diagonals summed round the polygon (its vector area): the normal
/// times the area.
Eigen::RowVector3d vectorArea(const ConstPoints& points, const Index* nodes, Index size);
}
