// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace morph
{
/// VTK's cell type numbers for the cells that this library knows.
enum CellType : std::uint8_t
{
  EmptyCell = 0,
  Vertex = 1,
  PolyVertex = 2,
  Line = 3,
  PolyLine = 4,
  Triangle = 5,
  TriangleStrip = 6,
  Polygon = 7,
  Pixel = 8,
  Quad = 9,
  Tetra = 10,
  Voxel = 11,
  Hexahedron = 12,
  Wedge = 13,
  Pyramid = 14,
  QuadraticEdge = 21,
  QuadraticTriangle = 22,
  QuadraticQuad = 23,
  QuadraticTetra = 24,
  QuadraticHexahedron = 25,
  QuadraticWedge = 26,
  QuadraticPyramid = 27,
  BiquadraticQuad = 28,
  TriquadraticHexahedron = 29,
  QuadraticLinearQuad = 30,
  QuadraticLinearWedge = 31,
  BiquadraticQuadraticWedge = 32,
  BiquadraticQuadraticHexahedron = 33,
  BiquadraticTriangle = 34,
  CubicLine = 35,
  QuadraticPolygon = 36,
  TriquadraticPyramid = 37,
  Polyhedron = 42,
  // Of any order.
  LagrangeCurve = 68,
  LagrangeTriangle = 69,
  LagrangeQuadrilateral = 70,
  LagrangeTetrahedron = 71,
  LagrangeHexahedron = 72,
  LagrangeWedge = 73,
  BezierCurve = 75,
  BezierTriangle = 76,
  BezierQuadrilateral = 77,
  BezierTetrahedron = 78,
  BezierHexahedron = 79,
  BezierWedge = 80
};

/// The linear shape that a cell's corners span.
enum class Shape : std::uint8_t
{
  Other, ///< of dimension 0 to 2, without a quality measure: kept as it is
  Tri,
  Quadrilateral,
  Tet,
  Hex,
  Wedge,
  Pyramid,
  Polyhedron ///< no corners or faces of the table: those of each cell are in the mesh
};

/// A face of a volume cell, by the cell's corner numbers. Its normal points outward by the
/// right-hand rule for a valid cell in VTK's order.
struct FaceShape
{
  int size; ///< 3 or 4
  int corner[4];
};

/// The properties of one cell type. Corners come first in the node list of every type here.
struct CellShape
{
  const char* name; ///< as in VTK: "hexahedron"
  Shape shape;
  int dimension;     ///< 0 to 3
  int numberOfNodes; ///< -1 where the type leaves it open (poly-line, polygon, any order)
  int numberOfCorners;
  int numberOfFaces; ///< of volume cells; 0 otherwise
  const FaceShape* faces;
  /// Position of the shape's corner i (VTK's hexahedron order) in the cell's node list. It is the
  /// identity except for voxels, whose third and fourth corners are exchanged.
  const int* cornerNode;
  /// Nominal parametric coordinates of the nodes after the corners (mid-side, face, body).
  /// (numberOfNodes - numberOfCorners) x 3; null where there are none or dimension < 3.
  const double (*extraNodes)[3];
  /// Whether quality and certificate know the map of the nodes after the corners (CellMap.h).
  /// Without it, quality is that of the corners, and the certificate is undecided.
  bool isMapped = true;
};

/// The highest order of Lagrange and Bezier cells.
constexpr int HighestOrder = 10;

/// Returns null for a type that this library does not know.
const CellShape* cellShape(std::uint8_t type);

/// The shape of a cell of a type of any order (Lagrange, Bezier) that has so many nodes: those of
/// an order that is the same in all directions, or VTK's tetrahedron of 15, wedge of 21 and
/// triangle of 7 nodes. Null for another number, or an order above HighestOrder.
const CellShape* shapeOfAnyOrder(std::uint8_t type, Index nodes);

/// What a cell is, by its type and its nodes; null as above. Whoever works on the cells of a mesh
/// asks here, so that they are recognized in one place.
inline const CellShape* cellShape(const Mesh& mesh, Index cell)
{
  const std::uint8_t type = mesh.types[cell];
  return type < LagrangeCurve ? cellShape(type) : shapeOfAnyOrder(type, mesh.cellSize(cell));
}
/// Null of other cells than those of volumes, too.
inline const CellShape* volumeShape(const Mesh& mesh, Index cell)
{
  const CellShape* shape = cellShape(mesh, cell);
  return shape && shape->dimension == 3 ? shape : nullptr;
}

/// Copies the positions of a cell's corners, in the order of its shape. `points`: #nodes x 3;
/// `corners`: numberOfCorners x 3.
template <typename Positions>
void copyCorners(
  const Mesh& mesh, Index cell, const CellShape& shape, const Positions& points, double* corners)
{
  for (int k = 0; k < shape.numberOfCorners; ++k)
  {
    const Index node = mesh.cell(cell)[shape.cornerNode[k]];
    for (int j = 0; j < 3; ++j)
    {
      corners[3 * k + j] = points(node, j);
    }
  }
}

/// The node ids of four of a cell's corners, by their numbers in its shape.
inline std::array<Index, 4> nodesAt(
  const Mesh& mesh, Index cell, const CellShape& shape, const int (&corner)[4])
{
  std::array<Index, 4> nodes;
  std::transform(
    corner, corner + 4, nodes.begin(), [&](int k) { return mesh.cell(cell)[shape.cornerNode[k]]; });
  return nodes;
}

/// The four edges of a hexahedron along each parametric direction, by their ends, at (0,0), (1,0),
/// (0,1), (1,1) of the other two directions.
inline constexpr int HexAxisEdges[3][4][2] = { { { 0, 1 }, { 3, 2 }, { 4, 5 }, { 7, 6 } },
  { { 0, 3 }, { 1, 2 }, { 4, 7 }, { 5, 6 } }, { { 0, 4 }, { 1, 5 }, { 3, 7 }, { 2, 6 } } };

/// Evaluates the linear shape functions N_a and their parametric gradients at `xi`. Volume shapes
/// only. `xi`: VTK's parametric coordinates, in [0, 1]. `N`: numberOfCorners values. `dN`:
/// numberOfCorners x 3, or null.
void shapeFunctions(Shape shape, const double xi[3], double* N, double (*dN)[3]);
}
