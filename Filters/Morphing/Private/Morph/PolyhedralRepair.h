// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/NodePartition.h"
#include "Support/Monitor.h"

#include <cstddef>
#include <functional>

namespace morph
{
class Morpher;
}

/// The inversion-free method on meshes with polyhedra, whose pieces it sees (PolyhedronPieces.h).
namespace morph::filters::PolyhedralRepair
{
/// Sets what `method` needs on pieces, if it is the inversion-free one.
void Adapt(morph::Morpher& method);

/// Repairs `moved`, #nodes x 3, in rounds: each puts the centers back to the means of their nodes
/// and repairs the pieces. Keeps the mesh with the fewest bad polyhedra and other cells. Returns
/// whether none are left. `reference`: see morph::Morpher::setReference(). `bad`: their number.
bool Run(const morph::Mesh& mesh, const morph::Points& reference,
  const morph::NodePartition& partition,
  const std::function<std::size_t(const morph::Points& points)>& bad, morph::Points& moved,
  morph::Monitor& monitor);
}
