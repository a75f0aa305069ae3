// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/CellShape.h"

namespace morph
{
/// The places in a cell where its Jacobian determinant is measured: a corner and its three
/// neighbors along edges, in the order that makes the determinant of a valid cell positive.
inline constexpr int TetCornerNodes[1][4] = { { 0, 1, 2, 3 } };
inline constexpr int HexCornerNodes[8][4] = { { 0, 1, 3, 4 }, { 1, 2, 0, 5 }, { 2, 3, 1, 6 },
  { 3, 0, 2, 7 }, { 4, 7, 5, 0 }, { 5, 4, 6, 1 }, { 6, 5, 7, 2 }, { 7, 6, 4, 3 } };
/// The edges at each corner, in that order. The entry is e + 1 for edge e of the twelve in
/// HexAxisEdges (Mesh/CellShape.h), or -(e + 1) if it ends at the corner.
inline constexpr int HexCornerEdges[8][3] = { { 1, 5, 9 }, { 6, -1, 10 }, { -2, -6, 12 },
  { -5, 2, 11 }, { 7, 3, -9 }, { -3, 8, -10 }, { -8, -4, -12 }, { 4, -7, -11 } };
inline constexpr int WedgeCornerNodes[6][4] = { { 0, 1, 2, 3 }, { 1, 2, 0, 4 }, { 2, 0, 1, 5 },
  { 3, 5, 4, 0 }, { 4, 3, 5, 1 }, { 5, 4, 3, 2 } };
/// At the base alone.
inline constexpr int PyramidCornerNodes[4][4] = { { 0, 1, 3, 4 }, { 1, 2, 0, 4 }, { 2, 3, 1, 4 },
  { 3, 0, 2, 4 } };

/// Calls take(a, b, c) with three edges at each place where measureQuality() takes a determinant:
/// the corners in their order, then a hexahedron's center, with sums of four edges. `x`: the
/// corners in the order of the shape; positions, or matrices of three rows that are linear in them.
template <typename X, typename Take>
void forEachMeasuredPlace(Shape shape, const X* x, const Take& take)
{
  const auto corners = [&](const auto& list)
  {
    for (const int(&c)[4] : list)
    {
      take(X(x[c[1]] - x[c[0]]), X(x[c[2]] - x[c[0]]), X(x[c[3]] - x[c[0]]));
    }
  };
  switch (shape)
  {
    case Shape::Tet:
      return corners(TetCornerNodes);
    case Shape::Wedge:
      return corners(WedgeCornerNodes);
    case Shape::Pyramid:
      return corners(PyramidCornerNodes);
    case Shape::Hex:
      break;
    default:
      return;
  }
  corners(HexCornerNodes);
  X center[3];
  for (int d = 0; d < 3; ++d)
  {
    center[d].setZero();
    for (const int(&ends)[2] : HexAxisEdges[d])
    {
      center[d] += x[ends[1]] - x[ends[0]];
    }
  }
  take(center[0], center[1], center[2]);
}
}
