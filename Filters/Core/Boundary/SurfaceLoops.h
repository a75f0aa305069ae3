// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/Classification.h"
#include "Mesh/Topology.h"

#include <vector>

namespace morph
{
/// The closed chains of corners (node ids) round some faces, in the direction in which the faces
/// run through them: the outer one counter-clockwise round the normals, holes clockwise. Each chain
/// starts at its lowest node; chains are in the order of those. Empty where the faces are closed,
/// and where chains cannot be told apart: faces wound against each other, or rims that touch in a
/// node.
std::vector<std::vector<Index>> boundaryLoops(
  const BoundaryFaces& faces, const std::vector<Index>& some);
}
