// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/CellShape.h"
#include "Quality/CornerNodes.h"

namespace morph
{
/// Calls take(a, b, c) with three edges at each place where measureQuality() takes a determinant:
/// the corners in their order, then a hexahedron's centre, with sums of four edges. `x`: the
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
