// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/HangingNodes.h"
#include "Morpher/Morpher.h"

#include <memory>

namespace morph
{
/// Returns a morpher for meshes with polyhedra that uses `method`, not prepared, on their pieces
/// (PolyhedronPieces.h). It is a LinearMorpher where `method` is one. Centers of prescribed faces
/// move as the mean of their nodes; the other centers are unknowns, dropped from the result. Ids of
/// cells in the method's messages are those of pieces: beyond the mesh's cells for all but the
/// first piece of a polyhedron. `cutsAll`: see PolyhedronPieces. Cost: that of the method on the
/// pieces. `hanging`: of the mesh, whose cells at divided faces are cut into pieces, too. Nodes
/// that hang and are free move by their ties, and not as the method has it.
std::unique_ptr<Morpher> morpherForPolyhedra(
  std::unique_ptr<Morpher> method, bool cutsAll = false, HangingNodes hanging = {});

/// Whether a method works on pieces of some cells: of polyhedra, and of cells at divided faces.
bool needsPieces(const Mesh& mesh, const HangingNodes& hanging);

/// Returns the method that works on the pieces, or `morpher` itself if it is no such wrapper.
Morpher& methodOf(Morpher& morpher);
}
