// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Formats/SolverMesh.h"

#include <vector>

/// The elements of CGNS ("SIDS: Unstructured Grid Element Numbering Conventions").
namespace morph::io
{
struct CgnsElement
{
  std::uint8_t cellType = EmptyCell; ///< EmptyCell: not known here
  int nodes = 0;
};

/// By the number of its ElementType_t.
CgnsElement cgnsElement(Index type);

/// Puts the nodes of an element into VTK's order.
void cgnsToVtkOrder(std::uint8_t cellType, std::vector<Index>& nodes);
}
