// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/CellShape.h"
#include "Mesh/Mesh.h"
#include "Support/Communicator.h"
#include "Support/Lists.h"
#include "Support/Monitor.h"

#include <cstdint>
#include <utility>
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

/// Returns those boundary faces that belong to a cell with a nonzero entry in `isOf` (#cells), with
/// the nodes on them. `faces`: boundaryFaces(mesh). Cost: one pass over the faces.
BoundaryFaces facesOfCells(
  const Mesh& mesh, const BoundaryFaces& faces, const std::vector<std::uint8_t>& isOf);

/// Returns the faces from `first` to before `last`, with the nodes on them, in the same way: with
/// the corners that their edges were given where they are divided (HangingNodes.h).
BoundaryFaces facesBetween(const Mesh& mesh, const BoundaryFaces& faces, Index first, Index last);

/// Gives faces other corners. Those that were no corners before are nodes of the boundary now, and
/// between no others.
void setCorners(std::vector<Index> offsets, std::vector<Index> connectivity, BoundaryFaces& faces);

/// Describes faces that are known to be on the boundary: of each the cell, a volume cell, and the
/// number of the face as in BoundaryFaces::sides. Cost: one pass over the faces.
BoundaryFaces facesAt(const Mesh& mesh, const std::vector<std::pair<Index, int>>& places);

/// Calls body(a, b) for the edges of each volume cell, once for each adjacent face. `a`, `b`: ids
/// of corner nodes, in the order of the face.
template <typename Body>
void forCellEdges(const Mesh& mesh, const Body& body)
{
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const CellShape& shape = *cellShape(mesh, c);
    for (int f = 0; f < shape.numberOfFaces; ++f)
    {
      const FaceShape& face = shape.faces[f];
      for (int k = 0; k < face.size; ++k)
      {
        body(mesh.cell(c)[shape.cornerNode[face.corner[k]]],
          mesh.cell(c)[shape.cornerNode[face.corner[(k + 1) % face.size]]]);
      }
    }
  }
}

/// The k-ring neighborhood of a set of cells.
struct KRing
{
  std::vector<Index> nodes; ///< free corners of the seeds and of the first k rings, ascending
  std::vector<Index> cells; ///< all cells with such a corner, ascending
};

/// `seeds`: cell ids; `rings`: k; `around`: nodeToCells(mesh); `free`: node ids, ascending. Cost:
/// passes over nodes and cells, and the neighborhood. On several processes the seeds are those of
/// all, and the result has the nodes and cells of this one.
KRing kRingOfCells(const Mesh& mesh, const Adjacency& around, const std::vector<Index>& free,
  const std::vector<Index>& seeds, int rings,
  const Communicator& communicator = Communicator::alone());
}
