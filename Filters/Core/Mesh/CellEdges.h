// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/CellShape.h"
#include "Mesh/Mesh.h"

namespace morph
{
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
}
