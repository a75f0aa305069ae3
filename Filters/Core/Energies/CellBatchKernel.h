// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Energies/CellBatches.h"
#include "Energies/FoldoverDensity.h"
#include "Energies/FoldoverKernel.h"

namespace morph
{
/// Common steps of functions on batches of cells: corners, and the Jacobians of their tetrahedra.
/// Few sources include this.
namespace foldover
{
using SimdVector = Vector3<SimdDouble4>;
using SimdMatrix = Matrix3<SimdDouble4>;

MORPH_SIMD_INLINE void cornersOf(
  const CellBatches& batches, Index batch, const Points& points, SimdVector (&x)[8])
{
  const std::int32_t* nodes = batches.nodes(batch);
  const int n = batches.corners(batch);
  for (int a = 0; a < n; ++a)
  {
    for (int lane = 0; lane < SimdWidth; ++lane)
    {
      const double* point = points.data() + 3 * static_cast<Index>(nodes[a * SimdWidth + lane]);
      x[a][0][lane] = point[0];
      x[a][1][lane] = point[1];
      x[a][2][lane] = point[2];
    }
  }
}

/// Computes the edges from a tetrahedron's first corner to the others, by columns.
MORPH_SIMD_INLINE void edgesOf(const SimdVector (&x)[8], const int* corner, SimdMatrix& D)
{
  for (int k = 0; k < 3; ++k)
  {
    for (int i = 0; i < 3; ++i)
    {
      D[k][i] = x[corner[k + 1]][i] - x[corner[0]][i];
    }
  }
}

/// Stores a batch's contributions to its corners at their places.
MORPH_SIMD_INLINE void storeAtPlaces(
  const CellBatches& batches, Index batch, const SimdVector (&sum)[8], Points& parts)
{
  double* out = parts.data() + 3 * batches.firstPlace(batch);
  const int corners = batches.corners(batch);
  for (int a = 0; a < corners; ++a)
  {
    for (int lane = 0; lane < SimdWidth; ++lane, out += 3)
    {
      out[0] = sum[a][0][lane];
      out[1] = sum[a][1][lane];
      out[2] = sum[a][2][lane];
    }
  }
}

MORPH_SIMD_INLINE void inverseOf(const CellBatches::Tetrahedra& tetrahedra, SimdMatrix& inverse)
{
  for (int j = 0; j < 3; ++j)
  {
    for (int i = 0; i < 3; ++i)
    {
      inverse[j][i] = load(tetrahedra.inverse[3 * j + i]);
    }
  }
}

/// Computes J; it is the identity in lanes of weight 0, which keeps their numbers harmless.
MORPH_SIMD_INLINE void jacobian(const SimdVector (&x)[8], const int* corner,
  const CellBatches::Tetrahedra& tetrahedra, const SimdMatrix& inverse, SimdMatrix& J)
{
  SimdMatrix D;
  edgesOf(x, corner, D);
  multiply(D, inverse, J);
  const auto counts = load(tetrahedra.weight) > 0.;
  const SimdDouble4 zero = {}, one = zero + 1.;
  for (int j = 0; j < 3; ++j)
  {
    for (int i = 0; i < 3; ++i)
    {
      J[j][i] = counts ? J[j][i] : i == j ? one : zero;
    }
  }
}

MORPH_SIMD_INLINE void parametersOf(const FoldoverDensity& density,
  const CellBatches::Tetrahedra& tetrahedra, Parameters<SimdDouble4>& parameters)
{
  parameters.theta = load(tetrahedra.theta);
  parameters.epsilon = density.epsilon;
}
}
}
