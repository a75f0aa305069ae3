// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"
#include "Support/Monitor.h"

#include <array>
#include <utility>
#include <vector>

namespace morph
{
/// The edges of boundary faces, between corners, and their adjacent faces.
struct SurfaceEdges
{
  std::vector<std::array<Index, 2>> nodes; ///< #edges, lower node id first, ascending
  Adjacency faces;                         ///< #edges: the faces that use the edge, ascending
  Adjacency ofFace; ///< #faces: its edges, the k-th from its corner k to the next
  /// #edges, degrees in [0, 180]: the angle between the normals of the edge's two faces. It is 0
  /// where they continue each other, for any winding, and NaN unless exactly two faces meet. A face
  /// without area continues its neighbor at its longest edge. So the faces on both sides of it meet
  /// as if it were not there.
  std::vector<double> angle;
  /// Number of examinations of faces without area for a neighbor's normal, a measure of the cost.
  /// At most 5 times their number.
  Index visits = 0;

  Index count() const { return static_cast<Index>(this->nodes.size()); }
  /// Returns the edge between two nodes, or -1.
  Index find(Index a, Index b) const;
};

/// `points`: #nodes x 3. The normal of a face is that of its vector area, so it is defined for
/// warped quadrilaterals. Cost: a sort of the faces' edges round each node.
SurfaceEdges surfaceEdges(const ConstPoints& points, const BoundaryFaces& faces, Monitor& monitor);

/// Returns a polygon's vector area, the normal times the area: half the cross product of the
/// diagonals, summed around it.
Eigen::RowVector3d vectorArea(const ConstPoints& points, const Index* nodes, Index size);

/// A curve as a chain of nodes.
struct CurveChain
{
  /// In order, including mid-side nodes, from one vertex to the next; a single vertex is at both
  /// ends. A closed chain without a vertex starts at its lowest corner, which is not repeated.
  std::vector<Index> nodes;
  std::vector<Index> edges; ///< numbers in SurfaceEdges
  bool loop = false;        ///< closed, without a vertex
};

/// Cuts the curve edges into chains at the vertices. `edges`: numbers in `all`, ascending.
/// `isVertex`: #nodes, nonzero where a chain ends; every corner needs it unless it has two curve
/// edges. `middles`: (edge, mid-side node), sorted. A chain starts at the vertex with the lower
/// node id, and towards its lower neighbor if both ends are equal. Chains are numbered by their
/// lowest node, then by their lowest edge.
std::vector<CurveChain> curveChains(const SurfaceEdges& all, const std::vector<Index>& edges,
  const std::vector<std::uint8_t>& isVertex, const std::vector<std::pair<Index, Index>>& middles);

/// Returns arc length over total length, in [0, 1], for each node of the chain. Pieces between
/// nodes are straight. A loop returns to its first node at 1, which is not listed. Without length,
/// the nodes are equally spaced.
std::vector<double> arcLengthParameters(const ConstPoints& points, const CurveChain& chain);
}
