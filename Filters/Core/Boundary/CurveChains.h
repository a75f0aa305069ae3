// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/SurfaceEdges.h"

#include <utility>
#include <vector>

namespace morph
{
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
