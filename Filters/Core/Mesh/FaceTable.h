// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/CellShape.h"
#include "Mesh/Mesh.h"
#include "Mesh/Polyhedra.h"
#include "Support/Lists.h"
#include "Support/Monitor.h"

#include <algorithm>
#include <vector>

namespace morph
{
/// The faces of all volume cells, polyhedra among them, by their corners. Faces are equal if their
/// sets of corners are. A face is numbered once for each cell that has it.
struct FaceTable
{
  std::vector<Index> start; ///< #cells + 1, the first face of each cell
  /// The different corners of each face in its order; fewer than three where it is collapsed.
  Adjacency corners;
  std::vector<Index> first; ///< #faces, the lowest number of an equal face
  std::vector<Index> uses;  ///< #faces, how many faces are equal, itself included

  Index size(Index face) const
  {
    return this->corners.offsets[face + 1] - this->corners.offsets[face];
  }
};

/// Calls visit(nodes, size) for each face of a volume cell, with its corners, of which collapsed
/// cells repeat some. Of a quadrilateral that goes to a corner and back, and so covers itself, two
/// are visited. Other cells have none.
template <typename Visit>
void forEachSide(const Mesh& mesh, Index cell, Visit&& visit)
{
  if (isPolyhedron(mesh, cell))
  {
    forEachFace(mesh, cell, visit);
    return;
  }
  const CellShape* shape = volumeShape(mesh, cell);
  for (int f = 0; shape && f < shape->numberOfFaces; ++f)
  {
    Index nodes[4];
    const FaceShape& face = shape->faces[f];
    std::transform(face.corner, face.corner + face.size, nodes,
      [&](int k) { return mesh.cell(cell)[shape->cornerNode[k]]; });
    const bool isCovered = face.size == 4 && (nodes[0] == nodes[2] || nodes[1] == nodes[3]);
    visit(nodes, isCovered ? 2 : face.size);
  }
}

/// Cost: a pass over the cells and a sort of the faces by their lowest corner; about 150 bytes a
/// quadrilateral.
FaceTable faceTable(const Mesh& mesh, Monitor& monitor);
}
