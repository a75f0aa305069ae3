// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Topology.h"
#include "Support/Monitor.h"

#include <array>
#include <cstdint>
#include <vector>

namespace morph
{
/// Returns the pairs of boundary faces that run into each other at `moved` and did not at `rest`,
/// ascending, the lower number first. One face of each pair at least has moved. `rest`, `moved`:
/// #nodes x 3, finite. `orientation`: #cells, +1 or -1 (cellSigns()).
///
/// Faces count by their corners, a face of more than three as triangles around the mean of its
/// corners. Faces cross if they still do once one of them is pushed into its own body by a
/// thousandth of the shortest edges, so that rounding has no effect. Bodies that overlap cross
/// also where their sides lie in one plane and no edge passes through a face. Faces that share a
/// node may fold, but do not count. Nor do faces that are in contact at `rest`: the facets of
/// curved sides cross when bodies slide. A body that runs deeper into another one crosses other
/// faces, too.
///
/// The signs of the predicates are exact. Cost: a pass over the boundary, n log^3 n for n faces,
/// and some 100 predicates for each pair of faces whose boxes overlap. Threads come from `monitor`.
std::vector<std::array<Index, 2>> crossingFaces(const ConstPoints& rest, const ConstPoints& moved,
  const BoundaryFaces& faces, const std::vector<std::int8_t>& orientation, Monitor& monitor);
}
