// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Energies/TargetMatrices.h"

namespace morph
{
/// Targets for the inverse mean ratio: theta is 0, so only the shape counts.
///
/// Initial: targetMatrices(), a cell's weight its volume. Ideal, other than there, takes no lengths
/// from a guide: one tetrahedron at each corner (but a pyramid's apex) of a cube, a regular
/// tetrahedron, a wedge or pyramid with all edges alike; every cell has the same weight, its
/// corners share it. Their size is that of the cell at rest, or of the mean cell where it has next
/// to no volume.
TargetMatrices smoothingTargets(const Mesh& rest, const std::vector<std::int8_t>& orientation,
  TargetConstruction target, Monitor& monitor);
}
