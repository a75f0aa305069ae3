// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace morph
{
/// Returns a plane mesh as a solid one layer thick, so that all that morphs and measures solids
/// works for it: triangles become wedges and quadrilaterals hexahedra, of the same scaled Jacobian
/// as the layer is orthogonal. Lines become the faces of its sides. Cells keep their ids, and nodes
/// those of the front; see PlaneLayer. Nodes in the middle of edges between front and back, which
/// quadratic cells have, come last. The layer is as thick as edges are long on the mean, which no
/// result depends on but by rounding. The normal is that about which most of the area is wound
/// counterclockwise.
///
/// Throws Error for a mesh that is not plane to 1e-6 of its size, or without area, and for cells
/// other than vertices, lines, triangles and quadrilaterals, linear or quadratic. Cost: passes over
/// the mesh.
Mesh thicken(const Mesh& plane);

/// How thick the layer is; 1 for a mesh that is none.
double thickness(const Mesh& mesh);

/// The images of the nodes of a layer among `ids`, ascending: their places in `ids`, front first.
/// Nodes whose image is not among them are left out.
std::vector<std::pair<Index, Index>> imagesAmong(
  const PlaneLayer& layer, const std::vector<Index>& ids);

/// Marks the images of nodes as these, #nodes of the mesh; other nodes keep their mark.
void markImages(const PlaneLayer& layer, std::vector<std::uint8_t>& marks);

/// Moves the nodes `ids`, ascending, of a layer into their plane, and both images of a node alike.
/// `moved`: #nodes x 3. Nothing happens without a layer.
void keepInPlane(const Mesh& rest, const std::vector<Index>& ids, Points& moved);
}
