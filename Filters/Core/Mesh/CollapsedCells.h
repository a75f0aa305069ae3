// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"

namespace morph
{
/// Replaces volume cells that name a corner more than once by the cells that they are: hexahedra
/// that are wedges, pyramids or tetrahedra, wedges that are pyramids or tetrahedra, pyramids that
/// are tetrahedra. So do their quadratic forms, whose nodes on an edge without length are its
/// corner. Cells whose faces cover one another have no volume, and become polygons, lines or
/// vertices. Cells of no such shape stay as they are. Numbers of cells and nodes stay. Returns
/// whether it has replaced any. Cost: a pass.
bool replaceCollapsedCells(Mesh& mesh);
}
