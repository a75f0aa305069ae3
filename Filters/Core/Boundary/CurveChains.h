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
  /// In order, mid-side nodes included, from one vertex to the next; where both are one vertex it
  /// stands at both ends. A closed chain without a vertex starts at its lowest corner and does not
  /// repeat it.
  std::vector<Index> nodes;
  std::vector<Index> edges; ///< numbers in SurfaceEdges
  bool loop = false;        ///< closed, without a vertex
};

/// Cuts the curve edges into chains at the vertices. `edges`: numbers in `all`, ascending;
/// `isVertex`: #nodes, nonzero where a chain ends; every corner with other than two curve edges has
/// to be one. `middles`: (edge, mid-side node), sorted. A chain starts at the vertex with the lower
/// node id, and at its lower neighbor where that leaves a choice; chains are numbered by their
/// lowest node, then by their lowest edge.
std::vector<CurveChain> curveChains(const SurfaceEdges& all, const std::vector<Index>& edges,
  const std::vector<std::uint8_t>& isVertex, const std::vector<std::pair<Index, Index>>& middles);

/// Arc length from the first node over the whole length, in [0, 1], along straight pieces between
/// the chain's nodes, #nodes; a loop comes back to its first node at 1, which is not listed. Where
/// the chain has no length its nodes are equally spaced.
std::vector<double> arcLengthParameters(const ConstPoints& points, const CurveChain& chain);
}
