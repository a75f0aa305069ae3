// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Support/Adjacency.h"
#include "Support/Communicator.h"
#include "Support/Monitor.h"

#include <cstdint>
#include <vector>

namespace morph
{
/// The boundary faces: faces that belong to a single volume cell, by their corners.
struct BoundaryFaces
{
  std::vector<Index> offsets = { 0 }; ///< #faces + 1, into `connectivity`
  /// node ids, outward by the right-hand rule for cells in VTK's order
  std::vector<Index> connectivity;
  std::vector<Index> cells; ///< #faces, the volume cell that owns the face
  std::vector<int> sides;   ///< #faces, its number in CellShape::faces or among the polyhedron's
  std::vector<Index> nodes; ///< sorted: all nodes of these faces, including mid-side and face nodes
  /// #nodes: corners of the edge or face whose middle the node is; empty for a corner
  Adjacency between;

  /// Appends a face's corners.
  template <typename Iterator>
  void add(Iterator first, Iterator last)
  {
    this->connectivity.insert(this->connectivity.end(), first, last);
    this->offsets.push_back(static_cast<Index>(this->connectivity.size()));
  }
  /// Takes the nodes from `connectivity`: all are corners.
  void takeNodes();
};

/// Returns for each node the volume cells with this corner, ascending and unique. Cost: two passes
/// over the connectivity. Threads come from `monitor`; without it there is one.
///@{
Adjacency nodeToCells(const Mesh& mesh, Monitor& monitor);
Adjacency nodeToCells(const Mesh& mesh);
///@}

/// Returns the faces that one cell alone uses. Faces are equal if their sets of corners are: a
/// collapsed quadrilateral is a triangle. A face collapsed to an edge is left out. Allows unused
/// points, several bodies, mixed and quadratic cells. Cost: a pass, and a sort of the faces by
/// their lowest corner.
BoundaryFaces boundaryFaces(const Mesh& mesh, Monitor& monitor);

/// The bodies of a mesh: volume cells connected by shared corners.
struct ConnectedComponents
{
  Index count = 0;
  std::vector<Index> ofCell; ///< #cells, body number, or -1 for a cell that is not a volume cell
  /// #nodes, body number, or -1 for a node that is no corner of a volume cell
  std::vector<Index> ofNode;
};
///@{
ConnectedComponents connectedComponents(
  const Mesh& mesh, Monitor& monitor, const Communicator& processes = Communicator::alone());
ConnectedComponents connectedComponents(const Mesh& mesh);
///@}
/// ConnectedComponents::ofNode with the nodes between corners, which have the body of their cell.
std::vector<Index> bodyOfNodes(const Mesh& mesh, const ConnectedComponents& bodies);

/// Returns +1 or -1 for each cell: the orientation of its node list, one sign per body and shape.
/// The sign is that of the summed signed volume. A single tet, hex or pyramid in a body has VTK's
/// order (+1). So a wholly mirrored body, or wedges in VTK's older order, count as valid. A cell
/// that is inverted among valid neighbors stays inverted. Cells below dimension 3 have +1.
///@{
std::vector<std::int8_t> cellSigns(const Mesh& mesh, const ConnectedComponents& bodies,
  Monitor& monitor, const Communicator& processes = Communicator::alone());
std::vector<std::int8_t> cellSigns(const Mesh& mesh, const ConnectedComponents& bodies);
///@}
}
