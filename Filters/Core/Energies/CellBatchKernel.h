// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Energies/CellBatches.h"
#include "Energies/FoldoverDensity.h"
#include "Energies/FoldoverKernel.h"

namespace morph
{
/// What a function on a group of cells needs first: corners, and the Jacobians of their tetrahedra. Included by few sources.
namespace foldover
{
using LaneVector = Vector3<Lanes>;
using LaneMatrix = Matrix3<Lanes>;

MORPH_LANES_INLINE void cornersOf(
  const CellGroups& groups, Index group, const Points& points, LaneVector (&x)[8])
{
  const std::int32_t* nodes = groups.nodes(group);
  const int n = groups.corners(group);
  for (int a = 0; a < n; ++a)
  {
    for (int lane = 0; lane < LaneCount; ++lane)
    {
      const double* point = points.data() + 3 * static_cast<Index>(nodes[a * LaneCount + lane]);
      x[a][0][lane] = point[0];
      x[a][1][lane] = point[1];
      x[a][2][lane] = point[2];
    }
  }
}

/// From a tetrahedron's first corner to the others, by columns.
MORPH_LANES_INLINE void edgesOf(const LaneVector (&x)[8], const int* corner, LaneMatrix& D)
{
  for (int k = 0; k < 3; ++k)
  {
    for (int i = 0; i < 3; ++i)
    {
      D[k][i] = x[corner[k + 1]][i] - x[corner[0]][i];
    }
  }
}

/// Writes what a group gives to its corners to their places.
MORPH_LANES_INLINE void storeAtPlaces(
  const CellGroups& groups, Index group, const LaneVector (&sum)[8], Points& parts)
{
  double* out = parts.data() + 3 * groups.firstPlace(group);
  const int corners = groups.corners(group);
  for (int a = 0; a < corners; ++a)
  {
    for (int lane = 0; lane < LaneCount; ++lane, out += 3)
    {
      out[0] = sum[a][0][lane];
      out[1] = sum[a][1][lane];
      out[2] = sum[a][2][lane];
    }
  }
}

MORPH_LANES_INLINE void inverseOf(const CellGroups::Tetrahedra& tetrahedra, LaneMatrix& inverse)
{
  for (int j = 0; j < 3; ++j)
  {
    for (int i = 0; i < 3; ++i)
    {
      inverse[j][i] = load(tetrahedra.inverse[3 * j + i]);
    }
  }
}

/// The identity in lanes of weight 0, which then are harmless numbers.
MORPH_LANES_INLINE void jacobian(const LaneVector (&x)[8], const int* corner,
  const CellGroups::Tetrahedra& tetrahedra, const LaneMatrix& inverse, LaneMatrix& J)
{
  LaneMatrix D;
  edgesOf(x, corner, D);
  multiply(D, inverse, J);
  const auto counts = load(tetrahedra.weight) > 0.;
  const Lanes zero = {}, one = zero + 1.;
  for (int j = 0; j < 3; ++j)
  {
    for (int i = 0; i < 3; ++i)
    {
      J[j][i] = counts ? J[j][i] : i == j ? one : zero;
    }
  }
}

MORPH_LANES_INLINE void parametersOf(const FoldoverDensity& density,
  const CellGroups::Tetrahedra& tetrahedra, Parameters<Lanes>& parameters)
{
  parameters.theta = load(tetrahedra.theta);
  parameters.stiffness = density.stiffness * load(tetrahedra.stiffened);
  parameters.epsilon = density.epsilon;
}
}
}
