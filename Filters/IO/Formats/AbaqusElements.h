// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Formats/SolverMesh.h"

#include <string>
#include <vector>

/// The elements of Abaqus and CalculiX (Abaqus Elements Guide; CalculiX CrunchiX manual, "Element
/// Types"), whose nodes are in VTK's order.
namespace morph::io
{
struct AbaqusElement
{
  std::uint8_t cellType = 0; ///< 0: not known here
  int nodes = 0;
};

/// The element of a TYPE in upper case: C3D8R, S4, ...
AbaqusElement abaqusElement(const std::string& type);

/// The corners, as positions in the element, of a face S1, S2, ... (`face` from 1) of a volume
/// element; none where there is no such face.
std::vector<int> abaqusFace(std::uint8_t cellType, int face);
}
