// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Formats/SolverMesh.h"

#include <optional>
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
  bool isPlane = false; ///< plane or axisymmetric, whose sides are edges: S1 is the first
};

/// The element of a TYPE in upper case: C3D8R, S4, ...
AbaqusElement abaqusElement(const std::string& type);

/// The corners, as positions in the element, of a side: S1, S2, ... are faces of a volume element
/// and edges of a plane one; a shell has its edges E1, E2, ..., which CalculiX calls S3, S4, ....
/// Empty: the element itself, as with SPOS. No value: it has no such side. `side`: in upper case.
std::optional<std::vector<int>> abaqusSide(
  std::uint8_t cellType, bool isPlane, const std::string& side);
}
