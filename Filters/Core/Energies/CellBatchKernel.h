// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Energies/CellBatches.h"
#include "Energies/EnergyState.h"
#include "Energies/FoldoverKernel.h"
#include "Mesh/SimplicialDecomposition.h"

namespace morph
{
/// The formulas of ConditionDensity for a number type T, double or SimdDouble4. Few sources include
/// this, as all is inlined.
namespace condition
{
using foldover::Matrix3;
using foldover::Vector3;

/// Computes kappa = sqrt(I K) / (3 D). `I`: squared norm of J; `K`: of its cofactors; `D`: its
/// determinant.
template <typename T>
MORPH_SIMD_INLINE void density(const T& I, const T& K, const T& D, T& kappa)
{
  const T infinity = T{} + std::numeric_limits<double>::infinity();
  kappa = squareRoot(I) * squareRoot(K) / (3. * D);
  kappa = select(D > 0., kappa, infinity);
  foldover::makeInfinite(kappa);
}

/// Computes kappa and its derivative by J, which is undefined where kappa is infinite.
template <typename T>
MORPH_SIMD_INLINE void gradient(const Matrix3<T>& J, T& kappa, Matrix3<T>& derivative)
{
  Matrix3<T> c;
  foldover::cofactor(J, c);
  T I, K, D;
  foldover::squaredNorm(J, I);
  foldover::squaredNorm(c, K);
  foldover::dot(J[0], c[0], D);
  density(I, K, D, kappa);
  for (int j = 0; j < 3; ++j)
  {
    const int k = (j + 1) % 3, l = (j + 2) % 3;
    Vector3<T> a, b; // their sum is half of dK / dJ_j
    foldover::cross(c[k], J[l], a);
    foldover::cross(J[k], c[l], b);
    for (int i = 0; i < 3; ++i)
    {
      derivative[j][i] = kappa * (J[j][i] / I + (a[i] + b[i]) / K - c[j][i] / D);
    }
  }
}

/// As foldover::hessian(). `J`: with a positive determinant.
template <typename T>
MORPH_SIMD_INLINE void hessian(const Matrix3<T>& J, const Matrix3<T>& g, Matrix3<T> (&block)[3][3])
{
  Matrix3<T> U, V;
  Vector3<T> s;
  foldover::signedSingularValues(J, U, s, V);
  const T q[3] = { s[0] * s[0], s[1] * s[1], s[2] * s[2] };
  const T I = q[0] + q[1] + q[2], K = q[0] * q[1] + q[0] * q[2] + q[1] * q[2];
  const T byI = 1. / I, byK = 1. / K;
  T kappa;
  density(I, K, T(s[0] * s[1] * s[2]), kappa);

  // By the logarithm of kappa, and its derivatives along the axes.
  Vector3<T> M, slope; // M: half of dK/ds
  for (int i = 0; i < 3; ++i)
  {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    M[i] = s[i] * (q[j] + q[k]);
    slope[i] = s[i] * byI + M[i] * byK - 1. / s[i];
  }
  Matrix3<T> A;
  for (int i = 0; i < 3; ++i)
  {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    A[i][i] = kappa * (slope[i] * slope[i] + byI - 2. * q[i] * byI * byI + (q[j] + q[k]) * byK -
                        2. * M[i] * M[i] * byK * byK + 1. / q[i]);
    A[j][i] = A[i][j] = kappa * (slope[i] * slope[j] - 2. * s[i] * s[j] * byI * byI +
                                  2. * s[i] * s[j] * byK - 2. * M[i] * M[j] * byK * byK);
  }
  Vector3<T> twist, shear;
  for (int k = 0; k < 3; ++k)
  {
    const T product = s[(k + 1) % 3] * s[(k + 2) % 3];
    twist[k] = kappa * (byI + (q[k] + product) * byK - 1. / product);
    shear[k] = kappa * (byI + (q[k] - product) * byK + 1. / product);
  }
  foldover::projectedHessian(U, V, A, twist, shear, g, block);
}
}

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
