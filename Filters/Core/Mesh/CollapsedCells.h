// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Support/Monitor.h"

#include <vector>

namespace morph
{
/// Replaces cells of a valid mesh by what methods, quality and boundary take them for. Numbers of
/// cells and nodes stay.
///
/// - Volume cells that name a corner more than once become the cells that they are: hexahedra that
///   are wedges, pyramids or tetrahedra, wedges that are pyramids or tetrahedra, pyramids that are
///   tetrahedra. So do their quadratic forms, whose nodes on an edge without length are its corner.
///   Other linear ones become polyhedra if their faces are closed, as a hexahedron of seven nodes;
///   a face with its opposite corners merged is none. Cells whose faces cover one another have no
///   volume, and become polygons, lines or vertices.
///   The rest stay as they are; see unrecognizedCells().
/// - Of volume cells with the same corners the first one counts; the others become poly-vertices of
///   these corners.
/// - Faces of polyhedra are turned outward, see orientPolyhedra().
///
/// Cost: a pass, and that of repeatedCells().
void recognizeCells(Mesh& mesh, Monitor& monitor);

/// Returns those of `cells` that name a corner more than once after recognizeCells(): corners
/// across the cell, or a quadratic cell that is no wedge, pyramid or tetrahedron.
std::vector<Index> unrecognizedCells(const Mesh& mesh, const std::vector<Index>& cells);
}
