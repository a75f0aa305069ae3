// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Formats/SolverMesh.h"

#include <vector>

namespace morph::io
{
/// A cell as VTK has it.
struct FoamCell
{
  std::uint8_t type = 0; ///< 0: a polyhedron of another shape
  std::vector<Index> nodes;
};

/// The hexahedron, wedge, pyramid or tetrahedron that these faces bound. `faces`: their nodes, each
/// with its normal out of the cell by the right-hand rule.
FoamCell foamCell(const std::vector<std::vector<Index>>& faces);
}
