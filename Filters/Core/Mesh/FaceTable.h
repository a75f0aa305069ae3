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

/// Whether a quadrilateral goes to a corner and back, and so covers itself.
inline bool coversItself(const Index* corners, Index size)
{
  return size == 4 && (corners[0] == corners[2] || corners[1] == corners[3]);
}

/// Calls visit(nodes, size) for each face of a volume cell, with its corners, of which collapsed
/// cells repeat some. Of one that covers itself two are visited. Other cells have none.
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
    visit(nodes, coversItself(nodes, face.size) ? 2 : face.size);
  }
}

/// Cost: a pass over the cells and a sort of the faces by their lowest corner; about 150 bytes a
/// quadrilateral.
FaceTable faceTable(const Mesh& mesh, Monitor& monitor);
}
