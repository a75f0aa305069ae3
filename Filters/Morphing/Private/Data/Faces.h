// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/CellShape.h"

#include <vector>

/// Faces of volume cells as linear polygons.
namespace morph::filters::Faces
{
/// Places in the cell's node list, in winding order.
using Polygon = std::vector<int>;

/// Face `face` of a volume cell, outward by the right-hand rule in a cell in VTK's order: one
/// polygon for a linear cell, and pieces through all nodes of the face for a quadratic one.
std::vector<Polygon> Pieces(const morph::CellShape& shape, int face);
}
