// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Simd.h"

#include <limits>

namespace morph
{
/// The formulas of FoldoverDensity for a number type T, double or SimdDouble4. Few sources include
/// this, as all is inlined.
namespace foldover
{
template <typename T>
struct Vector3
{
  T x[3];
  MORPH_SIMD_INLINE T& operator[](int i) { return this->x[i]; }
  MORPH_SIMD_INLINE const T& operator[](int i) const { return this->x[i]; }
};

template <typename T>
MORPH_SIMD_INLINE void dot(const Vector3<T>& a, const Vector3<T>& b, T& result)
{
  result = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <typename T>
MORPH_SIMD_INLINE void cross(const Vector3<T>& a, const Vector3<T>& b, Vector3<T>& result)
{
  result[0] = a[1] * b[2] - a[2] * b[1];
  result[1] = a[2] * b[0] - a[0] * b[2];
  result[2] = a[0] * b[1] - a[1] * b[0];
}

/// By columns.
template <typename T>
struct Matrix3
{
  Vector3<T> column[3];
  MORPH_SIMD_INLINE Vector3<T>& operator[](int j) { return this->column[j]; }
  MORPH_SIMD_INLINE const Vector3<T>& operator[](int j) const { return this->column[j]; }
};

template <typename T>
MORPH_SIMD_INLINE void multiply(const Matrix3<T>& A, const Vector3<T>& x, Vector3<T>& result)
{
  for (int i = 0; i < 3; ++i)
  {
    result[i] = A[0][i] * x[0] + A[1][i] * x[1] + A[2][i] * x[2];
  }
}

template <typename T>
MORPH_SIMD_INLINE void multiply(const Matrix3<T>& A, const Matrix3<T>& B, Matrix3<T>& result)
{
  for (int j = 0; j < 3; ++j)
  {
    multiply(A, B[j], result[j]);
  }
}

template <typename T>
MORPH_SIMD_INLINE void cofactor(const Matrix3<T>& J, Matrix3<T>& result)
{
  cross(J[1], J[2], result[0]);
  cross(J[2], J[0], result[1]);
  cross(J[0], J[1], result[2]);
}

template <typename T>
MORPH_SIMD_INLINE void squaredNorm(const Matrix3<T>& J, T& result)
{
  result = T{};
  for (int j = 0; j < 3; ++j)
  {
    T square;
    dot(J[j], J[j], square);
    result += square;
  }
}

template <typename T>
struct Parameters
{
  T theta;
  double epsilon;
};

/// chi and its derivatives by the determinant D.
template <typename T>
struct Regularised
{
  T chi, first, second;

  MORPH_SIMD_INLINE Regularised(const T& D, double epsilon)
  {
    const double square = epsilon * epsilon;
    const T root = squareRoot(square + D * D);
    // The second form avoids the cancellation of the first.
    this->chi = select(D > 0., (D + root) / 2., square / (2. * (root - D)));
    this->first = this->chi / root;
    this->second = square / (2. * root * root * root);
  }
};

/// Where the density is not finite, it is infinite, so that no step may end there.
template <typename T>
MORPH_SIMD_INLINE void makeInfinite(T& value)
{
  const T infinity = T{} + std::numeric_limits<double>::infinity();
  value = select(value < infinity, value, infinity);
}

/// Computes the density. `I`: squared norm of J; `D`: its determinant.
template <typename T>
MORPH_SIMD_INLINE void density(const Parameters<T>& p, const T& I, const T& D, T& phi)
{
  const Regularised<T> r(D, p.epsilon);
  const T root = 1. / cubeRoot(r.chi);
  phi = (1. - p.theta) / 3. * I * (root * root) + p.theta / 2. * (1. + D * D) / r.chi;
  makeInfinite(phi);
}

/// The density and its derivatives by I and D, which are undefined where it is infinite.
template <typename T>
struct Derivatives
{
  T value, I, D, ID, DD; ///< it is linear in I
};

template <typename T>
MORPH_SIMD_INLINE void derivatives(
  const Parameters<T>& parameters, const T& I, const T& D, Derivatives<T>& d)
{
  const T a = (1. - parameters.theta) / 3., b = parameters.theta / 2.;
  const Regularised<T> r(D, parameters.epsilon);
  const T inverse = 1. / r.chi, root = 1. / cubeRoot(r.chi), p = root * root;
  const T u = r.first * inverse, v = r.second * inverse;
  const T square = (1. + D * D) * inverse;
  const T shape = a * I * p;

  d.value = shape + b * square;
  d.I = a * p;
  d.D = -2. / 3 * shape * u + b * (2. * D * inverse - square * u);
  d.ID = -2. / 3 * a * p * u;
  d.DD = shape * (10. / 9 * u * u - 2. / 3 * v) +
         b * (2. * inverse - 4. * D * inverse * u - square * v + 2. * square * u * u);
  makeInfinite(d.value);
}

/// One Jacobi rotation for eigenvalues, of axes p and q; r is the third axis.
template <typename T>
MORPH_SIMD_INLINE void rotate(
  T& app, T& aqq, T& apq, T& apr, T& aqr, Vector3<T>& vp, Vector3<T>& vq)
{
  const T gap = aqq - app, one = T{} + 1.;
  const T root = squareRoot(gap * gap + 4. * apq * apq);
  const T sum = select(gap < 0., gap - root, gap + root);
  const T tangent = 2. * apq / select(sum == 0., one, sum);
  const T c = 1. / squareRoot(1. + tangent * tangent), s = tangent * c;
  app -= tangent * apq;
  aqq += tangent * apq;
  apq = T{};
  const T turned = c * apr - s * aqr;
  aqr = s * apr + c * aqr;
  apr = turned;
  for (int i = 0; i < 3; ++i)
  {
    const T x = c * vp[i] - s * vq[i];
    vq[i] = s * vp[i] + c * vq[i];
    vp[i] = x;
  }
}

/// Computes eigenvalues `e` and eigenvectors, the columns of a rotation V, of a symmetric matrix.
/// Only the lower triangle of `A` is read.
template <typename T>
MORPH_SIMD_INLINE void symmetricEigen(const Matrix3<T>& A, Vector3<T>& e, Matrix3<T>& V)
{
  constexpr int Sweeps = 4; // each squares the error
  T a00 = A[0][0], a11 = A[1][1], a22 = A[2][2], a01 = A[0][1], a02 = A[0][2], a12 = A[1][2];
  for (int j = 0; j < 3; ++j)
  {
    for (int i = 0; i < 3; ++i)
    {
      V[j][i] = T{} + (i == j ? 1. : 0.);
    }
  }
  for (int sweep = 0; sweep < Sweeps; ++sweep)
  {
    rotate(a00, a11, a01, a02, a12, V[0], V[1]);
    rotate(a00, a22, a02, a01, a12, V[0], V[2]);
    rotate(a11, a22, a12, a01, a02, V[1], V[2]);
  }
  e[0] = a00;
  e[1] = a11;
  e[2] = a22;
}

template <typename T>
MORPH_SIMD_INLINE void descend(T& a, T& b, Vector3<T>& va, Vector3<T>& vb)
{
  const auto swap = a < b;
  const T first = select(swap, b, a);
  b = select(swap, a, b);
  a = first;
  for (int i = 0; i < 3; ++i)
  {
    const T x = select(swap, vb[i], va[i]);
    vb[i] = select(swap, va[i], vb[i]);
    va[i] = x;
  }
}

/// Computes a unit vector perpendicular to the unit vector `u`.
template <typename T>
MORPH_SIMD_INLINE void perpendicular(const Vector3<T>& u, Vector3<T>& result)
{
  // Of the cross products with the axes, take a long one.
  const auto alongZ = u[2] * u[2] > u[0] * u[0];
  const T zero = T{};
  result[0] = select(alongZ, zero, -u[1]);
  result[1] = select(alongZ, -u[2], u[0]);
  result[2] = select(alongZ, u[1], zero);
  T square;
  dot(result, result, square);
  const T inverse = 1. / squareRoot(square);
  for (int i = 0; i < 3; ++i)
  {
    result[i] *= inverse;
  }
}

/// Computes J = U diag(S) V^T with rotations U and V. Singular values descend; the last has the
/// sign of the determinant.
template <typename T>
MORPH_SIMD_INLINE void signedSingularValues(
  const Matrix3<T>& J, Matrix3<T>& U, Vector3<T>& S, Matrix3<T>& V)
{
  Matrix3<T> A;
  for (int i = 0; i < 3; ++i)
  {
    for (int j = 0; j <= i; ++j)
    {
      dot(J[i], J[j], A[j][i]);
    }
  }
  Vector3<T> e;
  symmetricEigen(A, e, V);
  descend(e[0], e[1], V[0], V[1]);
  descend(e[1], e[2], V[1], V[2]);
  descend(e[0], e[1], V[0], V[1]);
  cross(V[0], V[1], V[2]);

  // The left vectors result from orthogonalisation in descending order, so a vanishing singular
  // value takes the remaining direction.
  Vector3<T> f[3];
  for (int j = 0; j < 3; ++j)
  {
    multiply(J, V[j], f[j]);
  }
  const T one = T{} + 1.;
  T square, along;
  dot(f[0], f[0], square);
  const T length = squareRoot(square);
  const auto some = length > 0.;
  const T inverse = 1. / select(some, length, one);
  for (int i = 0; i < 3; ++i)
  {
    U[0][i] = select(some, f[0][i] * inverse, V[0][i]);
  }
  dot(f[1], U[0], along);
  Vector3<T> second;
  for (int i = 0; i < 3; ++i)
  {
    second[i] = f[1][i] - along * U[0][i];
  }
  dot(second, second, square);
  const T across = squareRoot(square);
  const auto wide = across > 1e-14 * length;
  const T scale = 1. / select(wide, across, one);
  Vector3<T> other;
  perpendicular(U[0], other);
  for (int i = 0; i < 3; ++i)
  {
    U[1][i] = select(wide, second[i] * scale, other[i]);
  }
  cross(U[0], U[1], U[2]);
  for (int j = 0; j < 3; ++j)
  {
    dot(U[j], f[j], S[j]);
  }
}

/// Sets the negative eigenvalues of a symmetric matrix to 0.
template <typename T>
MORPH_SIMD_INLINE void makeSemiDefinite(Matrix3<T>& A)
{
  // Most matrices are definite, which their leading minors show faster.
  const T minor = A[0][0] * A[1][1] - A[0][1] * A[0][1];
  const T determinant = A[2][2] * minor - A[0][2] * (A[0][2] * A[1][1] - A[0][1] * A[1][2]) +
                        A[1][2] * (A[0][2] * A[0][1] - A[0][0] * A[1][2]);
  const auto indefinite = !((A[0][0] > 0.) & (minor > 0.) & (determinant > 0.));
  if (!any(indefinite))
  {
    return;
  }
  Vector3<T> e;
  Matrix3<T> V;
  symmetricEigen(A, e, V);
  const T zero = T{};
  for (int i = 0; i < 3; ++i)
  {
    e[i] = select(e[i] > 0., e[i], zero);
  }
  for (int j = 0; j < 3; ++j)
  {
    for (int i = 0; i < 3; ++i)
    {
      const T clamped =
        V[0][i] * V[0][j] * e[0] + V[1][i] * V[1][j] * e[1] + V[2][i] * V[2][j] * e[2];
      A[j][i] = select(indefinite, clamped, A[j][i]);
    }
  }
}

/// Computes the second derivative, without its negative eigenvalues, of a density that depends on
/// the singular values alone. J = U diag(s) V^T. `A`: the second derivatives by s, changed;
/// `twist`, `shear`: the eigenvalues of rotations and shears between the two other axes; `g`: see
/// hessian(), by columns as the blocks.
template <typename T>
MORPH_SIMD_INLINE void projectedHessian(const Matrix3<T>& U, const Matrix3<T>& V, Matrix3<T>& A,
  const Vector3<T>& twist, const Vector3<T>& shear, const Matrix3<T>& g, Matrix3<T> (&block)[3][3])
{
  makeSemiDefinite(A);
  // Half the sum and half the difference of the two eigenvalues.
  Vector3<T> sum, difference;
  const T zero = T{};
  for (int k = 0; k < 3; ++k)
  {
    const T t = select(twist[k] > 0., twist[k], zero), s = select(shear[k] > 0., shear[k], zero);
    sum[k] = (s + t) / 2.;
    difference[k] = (s - t) / 2.;
  }

  Matrix3<T> h; // V^T g
  for (int a = 0; a < 3; ++a)
  {
    for (int i = 0; i < 3; ++i)
    {
      dot(V[i], g[a], h[a][i]);
    }
  }
  for (int a = 0; a < 3; ++a)
  {
    for (int b = a; b < 3; ++b)
    {
      Matrix3<T> K, UK;
      for (int i = 0; i < 3; ++i)
      {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        K[i][i] =
          A[i][i] * h[a][i] * h[b][i] + sum[k] * h[a][j] * h[b][j] + sum[j] * h[a][k] * h[b][k];
        K[j][i] = A[j][i] * h[a][i] * h[b][j] + difference[k] * h[a][j] * h[b][i];
        K[i][j] = A[j][i] * h[a][j] * h[b][i] + difference[k] * h[a][i] * h[b][j];
      }
      multiply(U, K, UK);
      for (int j = 0; j < 3; ++j)
      {
        for (int i = 0; i < 3; ++i)
        {
          block[a][b][j][i] = UK[0][i] * U[0][j] + UK[1][i] * U[1][j] + UK[2][i] * U[2][j];
        }
      }
    }
  }
}

/// The second derivative without its negative eigenvalues, for displacements of a tetrahedron's
/// corners 1 to 3. `g`: its columns are the shape function gradients of these corners.
/// `block`[a][b], by columns: 3 x 3, for corners a <= b. Closed form by the singular values (Smith,
/// de Goes, Kim, ACM Trans. Graph. 38(1) (2019)). Accurate to about 1e-7, enough for search
/// directions.
template <typename T>
MORPH_SIMD_INLINE void hessian(const Parameters<T>& parameters, const Matrix3<T>& J,
  const Matrix3<T>& g, Matrix3<T> (&block)[3][3])
{
  Matrix3<T> U, V;
  Vector3<T> s;
  signedSingularValues(J, U, s, V);
  const Vector3<T> c = { { s[1] * s[2], s[0] * s[2], s[0] * s[1] } }; // d(det)/ds
  Derivatives<T> d;
  derivatives(parameters, T(s[0] * s[0] + s[1] * s[1] + s[2] * s[2]), T(s[0] * c[0]), d);

  // Stretches along the axes, which are coupled.
  Matrix3<T> A;
  for (int i = 0; i < 3; ++i)
  {
    for (int j = 0; j <= i; ++j)
    {
      const T own = i == j ? 2. * d.I : d.D * s[3 - i - j];
      A[j][i] = A[i][j] = 2. * d.ID * (s[i] * c[j] + s[j] * c[i]) + d.DD * c[i] * c[j] + own;
    }
  }
  Vector3<T> twist, shear;
  for (int k = 0; k < 3; ++k)
  {
    twist[k] = 2. * d.I + d.D * s[k];
    shear[k] = 2. * d.I - d.D * s[k];
  }
  projectedHessian(U, V, A, twist, shear, g, block);
}
}
}
