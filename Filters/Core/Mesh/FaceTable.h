// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Support/Adjacency.h"
#include "Support/Monitor.h"

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

/// Cost: a pass over the cells and a sort of the faces by their lowest corner; about 150 bytes a
/// quadrilateral.
FaceTable faceTable(const Mesh& mesh, Monitor& monitor);
}
