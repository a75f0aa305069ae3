// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/CellShape.h"

#include <vector>

/// Faces of volume cells as linear polygons.
namespace morph::filters::Faces
{
/// Places in the cell's node list, in winding order.
using Polygon = std::vector<int>;

/// The polygons of face `face` of a volume cell, outward by the right-hand rule in VTK's order. A
/// linear cell has one polygon; one of higher order has pieces through all nodes of the face.
std::vector<Polygon> Pieces(const morph::CellShape& shape, int face);
}
