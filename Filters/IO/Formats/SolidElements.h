// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Formats/SolverMesh.h"

#include <utility>

namespace morph::io
{
/// The cell of a solid of LS-DYNA or Ansys with these nodes, and those of its nodes that the cell
/// has, in VTK's order. A hexahedron of 8 or 20 nodes some of which are equal is a tetrahedron, a
/// pyramid or a wedge. EmptyCell for another number of nodes.
std::pair<std::uint8_t, std::vector<Index>> solidElement(const std::vector<Index>& nodes);

/// The same of a shell: 3, 4, 6 or 8 nodes. One of four may have 0 or the third as its last; one of
/// eight that has the third twice is a triangle.
std::pair<std::uint8_t, std::vector<Index>> shellElement(std::vector<Index> nodes);
}
