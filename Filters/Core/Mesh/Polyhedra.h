// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/CellShape.h"
#include "Mesh/Mesh.h"

namespace morph
{
inline bool hasPolyhedra(const Mesh& mesh)
{
  return !mesh.faceOffsets.empty();
}

inline bool isPolyhedron(const Mesh& mesh, Index cell)
{
  return mesh.types[cell] == Polyhedron;
}

/// Whether the mesh has the cell's faces, by which it is cut and measured: those of a polyhedron,
/// or of the corners of a cell of higher order that names one twice; see recognizeCells().
inline bool hasFaces(const Mesh& mesh, Index cell)
{
  return hasPolyhedra(mesh) && mesh.faceOffsets[cell] < mesh.faceOffsets[cell + 1];
}

/// Calls visit(nodes, size) for each face of a cell that hasFaces(): `size` ids, outward by the
/// right-hand rule where the cell is valid. There are none in a mesh without the arrays of faces.
template <typename Visit>
void forEachFace(const Mesh& mesh, Index cell, Visit&& visit)
{
  if (!hasPolyhedra(mesh))
  {
    return;
  }
  const Index* face = mesh.faces.data() + mesh.faceOffsets[cell];
  const Index* end = mesh.faces.data() + mesh.faceOffsets[cell + 1];
  for (; face != end; face += *face + 1)
  {
    visit(face + 1, *face);
  }
}

/// The number of leading nodes of a volume cell that are its corners: all of a polyhedron.
inline Index cornerCount(const Mesh& mesh, Index cell, const CellShape& shape)
{
  return shape.shape == Shape::Polyhedron ? mesh.cellSize(cell) : shape.numberOfCorners;
}

/// Throws Error that names the polyhedra without a closed surface. Each needs four faces or more,
/// of three or more different nodes. The cell's nodes are those of its faces. Each edge belongs to
/// two faces, and the faces hang together. Part of validate(). Cost: a sort of each cell's edges,
/// about 2 microseconds a cell of six faces.
void requireClosedPolyhedra(const Mesh& mesh);

/// Turns the faces of polyhedra so that all of a cell's run alike. A cell whose faces did so stays
/// as it is; another one gets a positive volume. The polyhedra must be closed. Cost: as above.
void orientPolyhedra(Mesh& mesh);

/// The volume of a polyhedron, by triangles between the edges of each face and the mean of its
/// nodes. It is negative for a mirrored cell. `points`: #nodes x 3.
double polyhedronVolume(const Mesh& mesh, Index cell, const ConstPoints& points);
}
