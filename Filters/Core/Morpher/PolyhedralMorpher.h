// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Morpher/Morpher.h"

#include <memory>

namespace morph
{
/// Returns a morpher for meshes with polyhedra that uses `method`, not prepared, on their pieces
/// (PolyhedronPieces.h). It is a LinearMorpher where `method` is one. Centers of prescribed faces
/// move as the mean of their nodes; the other centers are unknowns, dropped from the result. Ids of
/// cells in the method's messages are those of pieces: beyond the mesh's cells for all but the
/// first piece of a polyhedron. `cutsAll`: see PolyhedronPieces. Cost: that of the method on the
/// pieces.
std::unique_ptr<Morpher> morpherForPolyhedra(std::unique_ptr<Morpher> method, bool cutsAll = false);

/// Returns this for a mesh with polyhedra, and `method` itself for others.
std::unique_ptr<Morpher> morpherForCells(const Mesh& mesh, std::unique_ptr<Morpher> method);

/// Returns the method that works on the pieces, or `morpher` itself if it is no such wrapper.
Morpher& methodOf(Morpher& morpher);
}
