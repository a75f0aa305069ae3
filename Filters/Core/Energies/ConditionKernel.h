// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Energies/FoldoverKernel.h"

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
}
