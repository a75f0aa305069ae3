// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/Classification.h"
#include "Mesh/Topology.h"

#include <vector>

namespace morph
{
/// Returns the closed chains of corners (node ids) around `some` faces, in the direction of the
/// faces. The outer chain is counter-clockwise around the normals, holes are clockwise. Each chain
/// starts at its lowest node; these order the chains. The result is empty for closed surfaces, for
/// opposite windings, and for rims that touch in a node.
std::vector<std::vector<Index>> boundaryLoops(
  const BoundaryFaces& faces, const std::vector<Index>& some);
}
