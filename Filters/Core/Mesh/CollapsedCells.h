// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Support/Monitor.h"

#include <cstdint>
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
///   a face with its opposite corners merged is none. Other cells of higher order stay, with the
///   faces of this polyhedron of their corners, by which they are cut and measured; the nodes
///   between corners follow these. Cells whose faces cover one another have no volume, and become
///   polygons, lines or vertices.
///   The rest stay as they are; see unrecognizedCells().
/// - Of volume cells with the same corners the first one counts; the others become poly-vertices of
///   these corners.
/// - Faces of polyhedra are turned outward, see orientPolyhedra().
///
/// Cost: a pass, and that of repeatedCells().
void recognizeCells(Mesh& mesh, Monitor& monitor);

/// Lets the one of lowest id count of volume cells with the same corners that still count. `ids`:
/// #cells, all different. `mesh`: joined of pieces after recognizeCells().
void keepFirstCopies(Mesh& mesh, const std::vector<std::int64_t>& ids, Monitor& monitor);

/// Returns those of `cells` that name a corner more than once and are no closed shape, as corners
/// across the cell. `mesh`: after recognizeCells().
std::vector<Index> unrecognizedCells(const Mesh& mesh, const std::vector<Index>& cells);
}
