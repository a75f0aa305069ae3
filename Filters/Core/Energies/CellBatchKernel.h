// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Energies/CellBatches.h"
#include "Energies/ConditionDensity.h"
#include "Energies/ConditionKernel.h"
#include "Energies/FoldoverDensity.h"
#include "Energies/FoldoverKernel.h"
#include "Mesh/SimplicialDecomposition.h"

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

/// The target cells of a batch.
struct SimdTargets
{
  SimdVector x[8];
  SimdDouble4 factor;
  const long long* included;

  MORPH_SIMD_INLINE SimdTargets(const CellBatches& batches, Index batch)
    : factor(load(batches.targets(batch).factor))
    , included(batches.targets(batch).included)
  {
    const CellBatches::TargetCorners* corner = batches.targetCorners(batch);
    const int n = batches.corners(batch);
    for (int a = 0; a < n; ++a)
    {
      for (int i = 0; i < 3; ++i)
      {
        this->x[a][i] = load(corner[a].x[i]);
      }
    }
  }
};

/// A tetrahedron of each cell of a batch: the inverse of the target's edges, and the weight. Lanes
/// that do not count have weight 0.
struct SimdTarget
{
  SimdMatrix inverse;
  SimdDouble4 weight;

  MORPH_SIMD_INLINE SimdTarget(const SimdTargets& targets, const WeightedTet& tetrahedron, int t)
  {
    SimdMatrix D, normal;
    edgesOf(targets.x, tetrahedron.corner, D);
    cofactor(D, normal);
    SimdDouble4 determinant;
    dot(D[0], normal[0], determinant);
    const SimdMask4 counts = hasBit(targets.included, t);
    const SimdDouble4 zero = {}, one = zero + 1.;
    this->weight = select(counts, tetrahedron.weight * targets.factor * determinant, zero);
    const SimdDouble4 reciprocal = 1. / select(counts, determinant, one);
    for (int j = 0; j < 3; ++j)
    {
      for (int i = 0; i < 3; ++i)
      {
        this->inverse[j][i] = normal[i][j] * reciprocal;
      }
    }
  }
};

/// Computes J; it is the identity in lanes of weight 0, which keeps their numbers harmless.
MORPH_SIMD_INLINE void jacobian(
  const SimdVector (&x)[8], const int* corner, const SimdTarget& target, SimdMatrix& J)
{
  SimdMatrix D;
  edgesOf(x, corner, D);
  multiply(D, target.inverse, J);
  const SimdMask4 counts = target.weight > 0.;
  const SimdDouble4 zero = {}, one = zero + 1.;
  for (int j = 0; j < 3; ++j)
  {
    for (int i = 0; i < 3; ++i)
    {
      J[j][i] = select(counts, J[j][i], i == j ? one : zero);
    }
  }
}

MORPH_SIMD_INLINE void parametersOf(
  const FoldoverDensity& density, Parameters<SimdDouble4>& parameters)
{
  parameters.theta = SimdDouble4{} + density.theta;
  parameters.epsilon = density.epsilon;
}

/// The same functions for each density: value, first derivatives times weight, and second ones.
MORPH_SIMD_INLINE void valueAt(
  const FoldoverDensity& density, const SimdMatrix& J, SimdDouble4& determinant, SimdDouble4& value)
{
  SimdVector normal;
  cross(J[1], J[2], normal);
  dot(J[0], normal, determinant);
  SimdDouble4 square;
  squaredNorm(J, square);
  Parameters<SimdDouble4> parameters;
  parametersOf(density, parameters);
  foldover::density(parameters, square, determinant, value);
}

MORPH_SIMD_INLINE void valueAt(
  const ConditionDensity&, const SimdMatrix& J, SimdDouble4& determinant, SimdDouble4& value)
{
  SimdMatrix normal;
  cofactor(J, normal);
  dot(J[0], normal[0], determinant);
  SimdDouble4 square, cofactors;
  squaredNorm(J, square);
  squaredNorm(normal, cofactors);
  condition::density(square, cofactors, determinant, value);
}

MORPH_SIMD_INLINE void slopeAt(
  const FoldoverDensity& density, const SimdDouble4& weight, const SimdMatrix& J, SimdMatrix& slope)
{
  SimdMatrix normal;
  cofactor(J, normal);
  SimdDouble4 determinant, square;
  dot(J[0], normal[0], determinant);
  squaredNorm(J, square);
  Parameters<SimdDouble4> parameters;
  parametersOf(density, parameters);
  Derivatives<SimdDouble4> d;
  derivatives(parameters, square, determinant, d);
  const SimdDouble4 byNorm = 2. * weight * d.I, byVolume = weight * d.D;
  for (int j = 0; j < 3; ++j)
  {
    for (int i = 0; i < 3; ++i)
    {
      slope[j][i] = byNorm * J[j][i] + byVolume * normal[j][i];
    }
  }
}

MORPH_SIMD_INLINE void slopeAt(
  const ConditionDensity&, const SimdDouble4& weight, const SimdMatrix& J, SimdMatrix& slope)
{
  SimdDouble4 value;
  condition::gradient(J, value, slope);
  for (int j = 0; j < 3; ++j)
  {
    for (int i = 0; i < 3; ++i)
    {
      slope[j][i] *= weight;
    }
  }
}

MORPH_SIMD_INLINE void curvatureAt(const FoldoverDensity& density, const SimdMatrix& J,
  const SimdMatrix& g, SimdMatrix (&block)[3][3])
{
  Parameters<SimdDouble4> parameters;
  parametersOf(density, parameters);
  hessian(parameters, J, g, block);
}

MORPH_SIMD_INLINE void curvatureAt(
  const ConditionDensity&, const SimdMatrix& J, const SimdMatrix& g, SimdMatrix (&block)[3][3])
{
  condition::hessian(J, g, block);
}
}
}
