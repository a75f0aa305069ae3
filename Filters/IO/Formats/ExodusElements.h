// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Formats/SolverMesh.h"

#include <string>
#include <vector>

/// The elements of Exodus II ("Exodus II: A Finite Element Data Model", SAND92-2137, section 4.8).
namespace morph::io
{
/// VTK's cell type of a block by its type ("HEX8", "TETRA", "SHELL4") and its nodes an element.
/// EmptyCell: not known here.
std::uint8_t exodusCellType(const std::string& type, Index nodes);

/// Puts the nodes of an element into VTK's order.
void exodusToVtkOrder(std::uint8_t cellType, std::vector<Index>& nodes);

/// The corners, as positions in the element, of a side (from 1) of an element; none where the side
/// does not exist or is no face.
std::vector<int> exodusSide(std::uint8_t cellType, Index side);
}
