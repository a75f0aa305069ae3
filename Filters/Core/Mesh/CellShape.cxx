// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/CellShape.h"

#include <array>

namespace morph
{
namespace
{
constexpr FaceShape TetFaces[] = { { 3, { 0, 1, 3 } }, { 3, { 1, 2, 3 } }, { 3, { 2, 0, 3 } },
  { 3, { 0, 2, 1 } } };
constexpr FaceShape HexFaces[] = { { 4, { 0, 4, 7, 3 } }, { 4, { 1, 2, 6, 5 } },
  { 4, { 0, 1, 5, 4 } }, { 4, { 3, 7, 6, 2 } }, { 4, { 0, 3, 2, 1 } }, { 4, { 4, 5, 6, 7 } } };
// Outward where the normal of (0, 1, 2) points towards (3, 4, 5), as Verdict's positive wedge.
constexpr FaceShape WedgeFaces[] = { { 3, { 0, 2, 1 } }, { 3, { 3, 4, 5 } }, { 4, { 0, 1, 4, 3 } },
  { 4, { 1, 2, 5, 4 } }, { 4, { 2, 0, 3, 5 } } };
constexpr FaceShape PyramidFaces[] = { { 4, { 0, 3, 2, 1 } }, { 3, { 0, 1, 4 } },
  { 3, { 1, 2, 4 } }, { 3, { 2, 3, 4 } }, { 3, { 3, 0, 4 } } };

constexpr int InOrder[] = { 0, 1, 2, 3, 4, 5, 6, 7 };
constexpr int VoxelOrder[] = { 0, 1, 3, 2, 4, 5, 7, 6 };

constexpr double TetExtra[][3] = { { .5, 0, 0 }, { .5, .5, 0 }, { 0, .5, 0 }, { 0, 0, .5 },
  { .5, 0, .5 }, { 0, .5, .5 } };
// 12 edges, 6 faces, body
constexpr double HexExtra[][3] = { { .5, 0, 0 }, { 1, .5, 0 }, { .5, 1, 0 }, { 0, .5, 0 },
  { .5, 0, 1 }, { 1, .5, 1 }, { .5, 1, 1 }, { 0, .5, 1 }, { 0, 0, .5 }, { 1, 0, .5 }, { 1, 1, .5 },
  { 0, 1, .5 }, { 0, .5, .5 }, { 1, .5, .5 }, { .5, 0, .5 }, { .5, 1, .5 }, { .5, .5, 0 },
  { .5, .5, 1 }, { .5, .5, .5 } };
// VTK's biquadratic-quadratic hexahedron has only the four side faces, in the same order.
constexpr double WedgeExtra[][3] = { { .5, 0, 0 }, { .5, .5, 0 }, { 0, .5, 0 }, { .5, 0, 1 },
  { .5, .5, 1 }, { 0, .5, 1 }, { 0, 0, .5 }, { 1, 0, .5 }, { 0, 1, .5 }, { .5, 0, .5 },
  { .5, .5, .5 }, { 0, .5, .5 } };
constexpr double PyramidExtra[][3] = { { .5, 0, 0 }, { 1, .5, 0 }, { .5, 1, 0 }, { 0, .5, 0 },
  { 0, 0, .5 }, { 1, 0, .5 }, { 1, 1, .5 }, { 0, 1, .5 }, { .5, .5, 0 }, { .5, 0, 1. / 3 },
  { 1, .5, 1. / 3 }, { .5, 1, 1. / 3 }, { 0, .5, 1. / 3 }, { .5, .5, .2 } };

constexpr CellShape flat(const char* name, Shape shape, int dimension, int nodes, int corners)
{
  return { name, shape, dimension, nodes, corners, 0, nullptr, InOrder, nullptr };
}
constexpr CellShape tet(const char* name, int nodes)
{
  return { name, Shape::Tet, 3, nodes, 4, 4, TetFaces, InOrder, TetExtra };
}
constexpr CellShape hex(const char* name, int nodes, const int* order = InOrder)
{
  return { name, Shape::Hex, 3, nodes, 8, 6, HexFaces, order, HexExtra };
}
constexpr CellShape wedge(const char* name, int nodes)
{
  return { name, Shape::Wedge, 3, nodes, 6, 5, WedgeFaces, InOrder, WedgeExtra };
}
constexpr CellShape pyramid(const char* name, int nodes)
{
  return { name, Shape::Pyramid, 3, nodes, 5, 5, PyramidFaces, InOrder, PyramidExtra };
}
}

const CellShape* cellShape(std::uint8_t type)
{
  static const auto table = []
  {
    std::array<CellShape, BezierWedge + 1> t{};
    t[EmptyCell] = flat("empty cell", Shape::Other, 0, -1, 0); // hidden ones keep their nodes
    t[Vertex] = flat("vertex", Shape::Other, 0, 1, 1);
    t[PolyVertex] = flat("poly-vertex", Shape::Other, 0, -1, 0);
    t[Line] = flat("line", Shape::Other, 1, 2, 2);
    t[PolyLine] = flat("poly-line", Shape::Other, 1, -1, 0);
    t[Triangle] = flat("triangle", Shape::Tri, 2, 3, 3);
    t[TriangleStrip] = flat("triangle strip", Shape::Other, 2, -1, 0);
    t[Polygon] = flat("polygon", Shape::Other, 2, -1, 0);
    t[Pixel] = flat("pixel", Shape::Quadrilateral, 2, 4, 4);
    t[Pixel].cornerNode = VoxelOrder;
    t[Quad] = flat("quad", Shape::Quadrilateral, 2, 4, 4);
    t[Tetra] = tet("tetrahedron", 4);
    t[Voxel] = hex("voxel", 8, VoxelOrder);
    t[Hexahedron] = hex("hexahedron", 8);
    t[Wedge] = wedge("wedge", 6);
    t[Pyramid] = pyramid("pyramid", 5);
    t[QuadraticEdge] = flat("quadratic edge", Shape::Other, 1, 3, 2);
    t[QuadraticTriangle] = flat("quadratic triangle", Shape::Tri, 2, 6, 3);
    t[QuadraticQuad] = flat("quadratic quad", Shape::Quadrilateral, 2, 8, 4);
    t[QuadraticTetra] = tet("quadratic tetrahedron", 10);
    t[QuadraticHexahedron] = hex("quadratic hexahedron", 20);
    t[QuadraticWedge] = wedge("quadratic wedge", 15);
    t[QuadraticPyramid] = pyramid("quadratic pyramid", 13);
    t[BiquadraticQuad] = flat("biquadratic quad", Shape::Quadrilateral, 2, 9, 4);
    t[TriquadraticHexahedron] = hex("triquadratic hexahedron", 27);
    t[QuadraticLinearQuad] = flat("quadratic-linear quad", Shape::Quadrilateral, 2, 6, 4);
    t[QuadraticLinearWedge] = wedge("quadratic-linear wedge", 12);
    t[BiquadraticQuadraticWedge] = wedge("biquadratic-quadratic wedge", 18);
    t[BiquadraticQuadraticHexahedron] = hex("biquadratic-quadratic hexahedron", 24);
    t[BiquadraticTriangle] = flat("biquadratic triangle", Shape::Tri, 2, 7, 3);
    t[CubicLine] = flat("cubic line", Shape::Other, 1, 4, 2);
    t[QuadraticPolygon] = flat("quadratic polygon", Shape::Other, 2, -1, 0);
    t[TriquadraticPyramid] = pyramid("triquadratic pyramid", 19);
    t[TriquadraticPyramid].isMapped = false;
    const auto addAnyOrder = [&t](int first, const std::array<const char*, 6>& names)
    {
      const CellShape shapes[] = { flat(names[0], Shape::Other, 1, -1, 2),
        flat(names[1], Shape::Tri, 2, -1, 3), flat(names[2], Shape::Quadrilateral, 2, -1, 4),
        tet(names[3], -1), hex(names[4], -1), wedge(names[5], -1) };
      for (const CellShape& shape : shapes)
      {
        CellShape& own = t[first++] = shape;
        own.extraNodes = nullptr; // they depend on the order
        own.isMapped = false;
      }
    };
    addAnyOrder(LagrangeCurve, { "Lagrange curve", "Lagrange triangle", "Lagrange quadrilateral",
                                 "Lagrange tetrahedron", "Lagrange hexahedron", "Lagrange wedge" });
    addAnyOrder(BezierCurve, { "Bezier curve", "Bezier triangle", "Bezier quadrilateral",
                               "Bezier tetrahedron", "Bezier hexahedron", "Bezier wedge" });
    t[Polyhedron] = { "polyhedron", Shape::Polyhedron, 3, -1, 0, 0, nullptr, InOrder, nullptr };
    return t;
  }();
  return type < table.size() && table[type].name ? &table[type] : nullptr;
}

void shapeFunctions(Shape shape, const double xi[3], double* N, double (*dN)[3])
{
  const double r = xi[0], s = xi[1], t = xi[2];
  switch (shape)
  {
    case Shape::Tet:
    {
      const double values[4] = { 1 - r - s - t, r, s, t };
      constexpr double gradients[4][3] = { { -1, -1, -1 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
      for (int a = 0; a < 4; ++a)
      {
        N[a] = values[a];
        for (int j = 0; dN && j < 3; ++j)
        {
          dN[a][j] = gradients[a][j];
        }
      }
      break;
    }
    case Shape::Hex:
    {
      constexpr int at[8][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0, 0, 1 },
        { 1, 0, 1 }, { 1, 1, 1 }, { 0, 1, 1 } };
      for (int a = 0; a < 8; ++a)
      {
        double value[3], slope[3];
        for (int j = 0; j < 3; ++j)
        {
          value[j] = at[a][j] ? xi[j] : 1 - xi[j];
          slope[j] = at[a][j] ? 1 : -1;
        }
        N[a] = value[0] * value[1] * value[2];
        if (dN)
        {
          dN[a][0] = slope[0] * value[1] * value[2];
          dN[a][1] = value[0] * slope[1] * value[2];
          dN[a][2] = value[0] * value[1] * slope[2];
        }
      }
      break;
    }
    case Shape::Wedge:
    {
      const double triangle[3] = { 1 - r - s, r, s };
      constexpr double slope[3][2] = { { -1, -1 }, { 1, 0 }, { 0, 1 } };
      for (int a = 0; a < 6; ++a)
      {
        const double along = a < 3 ? 1 - t : t;
        N[a] = triangle[a % 3] * along;
        if (dN)
        {
          dN[a][0] = slope[a % 3][0] * along;
          dN[a][1] = slope[a % 3][1] * along;
          dN[a][2] = triangle[a % 3] * (a < 3 ? -1 : 1);
        }
      }
      break;
    }
    case Shape::Pyramid:
    {
      constexpr int at[4][2] = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } };
      for (int a = 0; a < 4; ++a)
      {
        const double vr = at[a][0] ? r : 1 - r, vs = at[a][1] ? s : 1 - s;
        N[a] = vr * vs * (1 - t);
        if (dN)
        {
          dN[a][0] = (at[a][0] ? 1 : -1) * vs * (1 - t);
          dN[a][1] = vr * (at[a][1] ? 1 : -1) * (1 - t);
          dN[a][2] = -vr * vs;
        }
      }
      N[4] = t;
      if (dN)
      {
        dN[4][0] = dN[4][1] = 0;
        dN[4][2] = 1;
      }
      break;
    }
    default:
      break;
  }
}
}
