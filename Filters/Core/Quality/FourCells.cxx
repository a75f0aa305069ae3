// SPDX-License-Identifier: BSD-3-Clause
#include "Quality/FourCells.h"

#include "Mesh/CellShape.h"
#include "Quality/CornerNodes.h"
#include "Support/Simd.h"

#include <cmath>
#include <limits>

namespace morph
{
namespace
{
/// A vector in each of four cells.
struct Vector4
{
  SimdDouble4 x, y, z;
};

// Sums have the order of those in ScaledJacobian.cxx: (x + y) + z, or x + (y + z) at the edges and
// corners of hexahedra.

MORPH_SIMD_INLINE Vector4 operator-(const Vector4& a, const Vector4& b)
{
  return { a.x - b.x, a.y - b.y, a.z - b.z };
}

MORPH_SIMD_INLINE Vector4 operator+(const Vector4& a, const Vector4& b)
{
  return { a.x + b.x, a.y + b.y, a.z + b.z };
}

MORPH_SIMD_INLINE Vector4 cross(const Vector4& a, const Vector4& b)
{
  return { a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x };
}

MORPH_SIMD_INLINE SimdDouble4 lengthOf(const Vector4& a)
{
  return squareRoot(a.x * a.x + a.y * a.y + a.z * a.z);
}

MORPH_SIMD_INLINE SimdDouble4 determinant(const Vector4& a, const Vector4& b, const Vector4& c)
{
  const Vector4 normal = cross(b, c);
  return a.x * normal.x + a.y * normal.y + a.z * normal.z;
}

MORPH_SIMD_INLINE SimdDouble4 lengthOfEdge(const Vector4& a)
{
  return squareRoot(a.x * a.x + (a.y * a.y + a.z * a.z));
}

MORPH_SIMD_INLINE SimdDouble4 cornerDeterminant(
  const Vector4& a, const Vector4& b, const Vector4& c)
{
  const Vector4 normal = cross(b, c);
  return a.x * normal.x + (a.y * normal.y + a.z * normal.z);
}

/// Scales the vectors to length 1. Clears the lanes of `good` where that is no ordinary number.
MORPH_SIMD_INLINE void normalize(Vector4& a, const SimdDouble4& length, SimdMask4& good)
{
  good = good & (length > 1e-150) & (length < std::numeric_limits<double>::infinity());
  a = { a.x / length, a.y / length, a.z / length };
}

MORPH_SIMD_INLINE SimdDouble4 least(const SimdDouble4& a, const SimdDouble4& b)
{
  return select(b < a, b, a);
}

MORPH_SIMD_INLINE SimdDouble4 greatest(const SimdDouble4& a, const SimdDouble4& b)
{
  return select(a < b, b, a);
}

template <int Corners>
MORPH_SIMD_INLINE void loadCorners(const FourCells& cells, Vector4 (&x)[Corners])
{
  for (int k = 0; k < Corners; ++k)
  {
    x[k] = { load(cells.x[k][0]), load(cells.x[k][1]), load(cells.x[k][2]) };
  }
}

struct Hexes
{
  static MORPH_SIMD_INLINE void run(const FourCells& cells, double* scaledJacobian, bool& isGood)
  {
    Vector4 x[8];
    loadCorners(cells, x);
    SimdMask4 good = !SimdMask4{};
    Vector4 r = x[1] - x[0] + x[2] - x[3] + x[5] - x[4] + x[6] - x[7];
    Vector4 s = x[3] - x[0] + x[2] - x[1] + x[7] - x[4] + x[6] - x[5];
    Vector4 t = x[4] - x[0] + x[5] - x[1] + x[6] - x[2] + x[7] - x[3];
    normalize(r, lengthOf(r), good);
    normalize(s, lengthOf(s), good);
    normalize(t, lengthOf(t), good);
    SimdDouble4 minimum = determinant(r, s, t);
    // Each edge is at two corners.
    Vector4 edge[3][4];
    for (int d = 0; d < 3; ++d)
    {
      for (int k = 0; k < 4; ++k)
      {
        edge[d][k] = x[HexAxisEdges[d][k][1]] - x[HexAxisEdges[d][k][0]];
        normalize(edge[d][k], lengthOfEdge(edge[d][k]), good);
      }
    }
    for (const int(&at)[3] : HexCornerEdges)
    {
      Vector4 outgoing[3];
      for (int k = 0; k < 3; ++k)
      {
        const int number = (at[k] > 0 ? at[k] : -at[k]) - 1;
        const Vector4& along = edge[number / 4][number % 4];
        outgoing[k] = at[k] > 0 ? along : Vector4{ -along.x, -along.y, -along.z };
      }
      minimum = least(minimum, cornerDeterminant(outgoing[0], outgoing[1], outgoing[2]));
    }
    store(minimum, scaledJacobian);
    isGood = !any(!good);
  }
};

struct Tets
{
  static MORPH_SIMD_INLINE void run(const FourCells& cells, double* scaledJacobian, bool& isGood)
  {
    Vector4 x[4];
    loadCorners(cells, x);
    const Vector4 e01 = x[1] - x[0], e02 = x[2] - x[0], e03 = x[3] - x[0];
    const SimdDouble4 l01 = lengthOf(e01), l02 = lengthOf(e02), l03 = lengthOf(e03);
    const SimdDouble4 l12 = lengthOf(x[2] - x[1]), l13 = lengthOf(x[3] - x[1]),
                      l23 = lengthOf(x[3] - x[2]);
    const SimdDouble4 shortest = least(least(least(l01, l02), least(l03, l12)), least(l13, l23));
    const SimdDouble4 longest = greatest(
      greatest(greatest(l01 * l02 * l03, l01 * l12 * l13), l02 * l12 * l23), l03 * l13 * l23);
    const SimdDouble4 value = std::sqrt(2.0) * determinant(e01, e02, e03) / longest;
    store(value, scaledJacobian);
    const SimdDouble4 sum = l01 + l02 + l03 + l12 + l13 + l23; // NaN, too, is not below infinity
    isGood = !any(!((shortest > 1e-150) & (sum < std::numeric_limits<double>::infinity())));
  }
};
}

bool measureHexes(const FourCells& cells, double (&scaledJacobian)[SimdWidth])
{
  bool isGood = false;
  dispatched<Hexes>(cells, scaledJacobian, isGood);
  return isGood;
}

bool measureTets(const FourCells& cells, double (&scaledJacobian)[SimdWidth])
{
  bool isGood = false;
  dispatched<Tets>(cells, scaledJacobian, isGood);
  return isGood;
}
}
