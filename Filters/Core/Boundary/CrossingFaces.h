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
/// node may fold, but do not count.
///
/// The facets of curved sides in contact cross when bodies slide. So faces have to cross also if
/// one of them moves back into its body by the heights of both: as a whole, and also with the faces
/// at its corners. The height of a facet is how far it is from a smooth surface that turns by the
/// same angles a from face to face at its corners: c / 2 tan(a / 4) for faces of the size c. Angles
/// of more than 25 degrees are features, and do not count. Faces that are near each other at `rest`
/// may turn by 5 degrees where no face shows it.
///
/// The signs of the predicates are exact. Cost: a pass over the boundary, n log^3 n for n faces,
/// some 100 predicates for each pair of faces whose boxes overlap and, if some cross, a pass over
/// the pairs of faces at each corner. Threads come from `monitor`.
std::vector<std::array<Index, 2>> crossingFaces(const ConstPoints& rest, const ConstPoints& moved,
  const BoundaryFaces& faces, const std::vector<std::int8_t>& orientation, Monitor& monitor);
}
