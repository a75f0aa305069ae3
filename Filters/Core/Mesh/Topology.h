// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Support/Adjacency.h"
#include "Support/Monitor.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// The faces of volume cells that belong to one cell alone, by their corners.
struct BoundaryFaces
{
  std::vector<Index> offsets; ///< #faces + 1, into `connectivity`
  /// node ids, outward by the right-hand rule for cells in VTK's order
  std::vector<Index> connectivity;
  std::vector<Index> cells;        ///< #faces, the volume cell that owns the face
  std::vector<std::uint8_t> sides; ///< #faces, its number among the cell's faces (CellShape::faces)
  std::vector<Index> nodes; ///< sorted: every node on those faces, mid-side and face nodes included
  /// #nodes: the corners of the edge or face whose middle the node is; none for a corner
  Adjacency between;
};

/// For each node the volume cells it is a corner of, ascending, each once. Cost: two passes over
/// the connectivity.
Adjacency nodeToCells(const Mesh& mesh);

/// Faces used once. A face is told by the set of its corners: a collapsed quadrilateral is a
/// triangle, and a face collapsed to an edge is none. Cost: one pass plus a sort of the faces by
/// their lowest corner; works for unused points, several bodies, mixed cells and quadratic cells.
BoundaryFaces boundaryFaces(const Mesh& mesh, Monitor& monitor);

/// Bodies: volume cells that hang together through shared corners.
struct ConnectedComponents
{
  Index count = 0;
  std::vector<Index> ofCell; ///< #cells, body number, or -1 for a cell that is not a volume cell
  /// #nodes, body number, or -1 for a node that is no corner of a volume cell
  std::vector<Index> ofNode;
};
ConnectedComponents connectedComponents(const Mesh& mesh);

/// +1 or -1 for each cell: the order its node list was written in, one sign per body and shape,
/// from the summed signed volume; a single tet, hex or pyramid in a body is taken as VTK orders it
/// (+1). A body mirrored as a whole, or wedges in VTK's older order, are then measured as valid,
/// while a cell that is inverted among valid neighbors stays inverted. Cells below dimension 3: +1.
std::vector<std::int8_t> cellSigns(const Mesh& mesh, const ConnectedComponents& bodies);
}
