// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Formats/SolverMesh.h"

#include <vector>

/// The elements of Gmsh's MSH files (Gmsh's manual, "MSH file format" and "Node ordering").
namespace morph::io
{
struct GmshElement
{
  std::uint8_t cellType = EmptyCell; ///< EmptyCell: not known here
  int nodes = 0;
};

/// By the number of the element type in the file.
GmshElement gmshElement(Index type);

/// Puts the nodes of an element into VTK's order.
void gmshToVtkOrder(std::uint8_t cellType, std::vector<Index>& nodes);
}
